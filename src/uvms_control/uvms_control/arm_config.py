"""Parameters of the arm's control law, each with unit, bounds and meaning."""

from pydantic import Field

from uvms_core.config import Config


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
