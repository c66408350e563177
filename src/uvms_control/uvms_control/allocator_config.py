"""Parameters of the thrust allocator, each with unit, bounds and meaning."""

from typing import ClassVar

from pydantic import Field

from uvms_control.interfaces import AllocationMethod
from uvms_control.six import SixNotNegative
from uvms_core import registry
from uvms_core.plugin import PluginConfig, Slot


class AllocatorConfig(PluginConfig):
    """Bounded least-squares thrust allocation."""

    slot: ClassVar[Slot] = Slot(registry.ALLOCATORS, "method", AllocationMethod)

    method: str = Field(
        default="weighted_least_squares",
        description="allocation method: weighted_least_squares, that of an installed package, or a"
        " class as my_package.my_module:MyAllocator",
    )
    weights: SixNotNegative = Field(
        default=(1.0, 1.0, 1.0, 10.0, 10.0, 3.0),
        description="weight of the error on X, Y, Z, K, M, N as a share of the authority of each "
        "axis, no unit; roll and pitch come first when thrusters saturate",
    )
    regularisation: float = Field(
        default=1e-8,
        ge=1e-10,
        le=1.0,
        description="weight of the thrusts, as shares of their limits, against wrench errors",
    )
    preserve_direction: bool = Field(
        default=False,
        description="when thrusters saturate, scale the whole wrench down instead of giving up "
        "the axes of low weight first",
    )
    slew_aware: bool = Field(
        default=False,
        description="keep each thrust within what the thruster's slew limit reaches in a tick",
    )
    effectiveness: dict[str, float] = Field(
        default_factory=dict,
        description="share of its command that a thruster gives, by its name, as the user knows it"
        " (0 dead, 1 whole, at most 1.2); it comes before what the observer estimates",
    )
