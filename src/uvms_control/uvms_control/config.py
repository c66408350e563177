"""Parameters of the controller and of the thrust allocator, each with unit, bounds and meaning."""

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar

from pydantic import Field

from uvms_control.interfaces import AllocationMethod, ControlLaw
from uvms_core import registry
from uvms_core.config import Config
from uvms_core.plugin import PluginConfig, Slot

Positive = Annotated[float, Field(gt=0.0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0.0, allow_inf_nan=False)]
SixPositive = Annotated[tuple[Positive, ...], Field(min_length=6, max_length=6)]
SixNotNegative = Annotated[tuple[NotNegative, ...], Field(min_length=6, max_length=6)]


class VehicleControlConfig(Config):
    """S-surface law of the vehicle: one value per axis (surge, sway, heave, roll, pitch, yaw)."""

    k_error: SixPositive = Field(
        default=(2.0, 2.0, 2.0, 2.0, 2.0, 2.0),
        description="gain on the normalised error (the paper's K_d), no unit",
    )
    k_rate: SixPositive = Field(
        default=(2.0, 2.0, 2.0, 2.0, 2.0, 2.0),
        description="gain on the normalised rate of the error (the paper's K_p), no unit",
    )
    error_scale: SixPositive = Field(
        default=(0.15, 0.15, 0.15, 0.15, 0.15, 0.15),
        description="error that counts as one, m and rad",
    )
    rate_scale: SixPositive = Field(
        default=(0.1, 0.1, 0.1, 0.15, 0.15, 0.15),
        description="rate of the error that counts as one, m/s and rad/s",
    )
    amplitude: SixPositive = Field(
        default=(0.15, 0.15, 0.15, 0.6, 0.3, 0.3),
        description="largest acceleration of the law, m/s^2 and rad/s^2",
    )
    k_integral: SixNotNegative = Field(
        default=(0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        description="rate of the integral part of Delta-u for a normalised error of one, 1/s; "
        "0 where the observer's external part does this work",
    )
    integral_limit: float = Field(
        default=0.5, ge=0.0, le=1.0, description="bound on the integral part of Delta-u, no unit"
    )


class ArmControlConfig(Config):
    """S-surface law of the joints; the same for every joint, scaled by the joint-space inertia."""

    bandwidth: float = Field(
        default=6.0,
        gt=0.0,
        le=100.0,
        description="natural frequency of each joint's loop for small errors, rad/s",
    )
    damping_ratio: float = Field(
        default=1.0, gt=0.0, le=10.0, description="damping ratio for small errors, no unit"
    )
    amplitude: float = Field(
        default=10.0, gt=0.0, description="largest acceleration of the law, rad/s^2"
    )
    integral_rate: float = Field(
        default=1.0,
        ge=0.0,
        le=10.0,
        description="rate at which the integral takes over a steady load, 1/s; 0 for none",
    )
    integral_limit: float = Field(
        default=0.5,
        ge=0.0,
        le=1.0,
        description="bound on the integral as a share of the joint's effort limit",
    )
    friction_compensation: float = Field(
        default=1.0,
        ge=0.0,
        le=1.0,
        description="share of the modelled joint friction at the reference rate fed forward",
    )


class CompensationConfig(Config):
    """Correction of the joint reference that keeps the end effector on its path."""

    bandwidth: float = Field(
        default=2.0, gt=0.0, le=100.0, description="rate at which an error is corrected, 1/s"
    )
    damping: float = Field(
        default=0.05, gt=0.0, description="damping of the least-squares inverse, m/rad"
    )
    max_angle: float = Field(
        default=0.35, ge=0.0, description="bound on the correction of a joint, rad"
    )
    max_rate: float = Field(
        default=0.2, gt=0.0, description="bound on the rate of the correction of a joint, rad/s"
    )
    joint_margin: float = Field(
        default=0.02, ge=0.0, description="distance kept from the joint limits, rad"
    )


class ControlConfig(PluginConfig):
    """Vehicle and arm controller."""

    slot: ClassVar[Slot] = Slot(registry.CONTROLLERS, "law", ControlLaw)
    words: ClassVar[Mapping[str, Mapping[str, Any]]] = {"off": {"enabled": False}}

    law: str = Field(
        default="s_surface",
        description="control law: s_surface (eq. (22) and (19)), that of an installed package, or"
        " a class as my_package.my_module:MyLaw, which may ignore the other fields of this section",
    )
    enabled: bool = Field(
        default=True,
        description="control the vehicle; false leaves it free (zero wrench), the arm still moves",
    )
    observer: bool = Field(
        default=True, description="feed the observed disturbance forward, F_dis of eq. (22)"
    )
    compensate_vehicle_motion: bool = Field(
        default=True,
        description="move the joint reference so that the estimated end effector stays on its path",
    )
    vehicle: VehicleControlConfig = VehicleControlConfig()
    arm: ArmControlConfig = ArmControlConfig()
    compensation: CompensationConfig = CompensationConfig()


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
