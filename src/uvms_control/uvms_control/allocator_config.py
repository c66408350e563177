"""Parameters of the thrust allocator, each with unit, bounds and meaning."""

from typing import Annotated, Any, ClassVar, Literal, get_args

from pydantic import Field, field_validator

from uvms_control.interfaces import AllocationMethod
from uvms_control.six import SixNotNegative
from uvms_core import registry
from uvms_core.plugin import PluginConfig, Slot

Axis = Literal["X", "Y", "Z", "K", "M", "N"]
Level = Annotated[tuple[Axis, ...], Field(min_length=1)]

LAG_COMPENSATION = 0.8
"""Most of the delay for a fraction of the chatter: what is left of it costs more than it gives
(`make bench ARGS=thruster_lag`)."""


class AllocatorConfig(PluginConfig):
    """Thrust allocation within the thrusters' limits."""

    slot: ClassVar[Slot] = Slot(registry.ALLOCATORS, "method", AllocationMethod)

    method: str = Field(
        default="lexicographic",
        description="allocation method: lexicographic (by priorities), weighted_least_squares (by"
        " weights), that of an installed package, or a class as my_package.my_module:MyAllocator",
    )
    priorities: tuple[Level, ...] = Field(
        default=(("K", "M"), ("Z",), ("N",), ("X", "Y")),
        description="axes in levels, each axis once: when thrusters saturate, a level keeps all"
        " that it can have before the next one gets anything; within a level, weights decide",
    )
    weights: SixNotNegative = Field(
        default=(1.0, 1.0, 1.0, 10.0, 10.0, 3.0),
        description="weight of the error on X, Y, Z, K, M, N as a share of the authority of each "
        "axis, no unit, with priorities only within a level; 0: the axis is left out",
    )
    regularisation: float = Field(
        default=1e-8,
        ge=1e-10,
        le=1.0,
        description="weight of the thrusts, as shares of their limits, against wrench errors; with"
        " priorities, thrusts come after all of them",
    )
    preserve_direction: bool = Field(
        default=False,
        description="when thrusters saturate, scale the whole wrench down instead of giving up "
        "axes",
    )
    slew_aware: bool = Field(
        default=False,
        description="keep each thrust within what the thruster's slew limit reaches in a tick",
    )
    lag_compensation: float = Field(
        default=LAG_COMPENSATION,
        ge=0.0,
        le=1.0,
        description="share of the thrusters' lag that commands make up for by going beyond the"
        " wanted thrust; 1: it is there at the end of the control period; true and false are 1 and"
        " 0. weighted_least_squares makes up for none",
    )
    effectiveness: dict[str, float] = Field(
        default_factory=dict,
        description="share of its command that a thruster gives, by its name, as the user knows it"
        " (0 dead, 1 whole, at most 1.2); it comes before what the observer estimates",
    )

    @field_validator("lag_compensation", mode="before")
    @classmethod
    def _may_be_a_switch(cls, value: Any) -> Any:
        return float(value) if isinstance(value, bool) else value

    @field_validator("priorities")
    @classmethod
    def _has_each_axis_once(cls, levels: tuple[Level, ...]) -> tuple[Level, ...]:
        axes = [axis for level in levels for axis in level]
        for axis in get_args(Axis):
            if axes.count(axis) != 1:
                raise ValueError(
                    f"{axis} comes {axes.count(axis)} times in {[list(level) for level in levels]};"
                    " each of X, Y, Z, K, M, N must come once"
                )
        return levels
