"""Parameters of the arm's control law, each with unit, bounds and meaning."""

from pydantic import Field

from uvms_core.config import Config


class ArmControlConfig(Config):
    """S-surface law of the joints; the same for every joint, scaled by the joint-space inertia."""

    bandwidth: float | None = Field(
        default=None,
        gt=0.0,
        le=100.0,
        description="natural frequency of each joint's loop for small errors, rad/s; null: by rule,"
        " from control period, effort over inertia and encoder noise",
    )
    damping_ratio: float = Field(
        default=1.0, gt=0.0, le=10.0, description="damping ratio for small errors, no unit"
    )
    amplitude: float = Field(
        default=10.0, gt=0.0, description="largest acceleration of the law, rad/s^2"
    )
    load_limit: float = Field(
        default=0.5,
        ge=0.0,
        le=1.0,
        description="bound on the load that the joint observer finds beyond the model, as a share"
        " of the joint's effort limit; 0: no load is looked for",
    )
    friction_compensation: float = Field(
        default=1.0,
        ge=0.0,
        le=1.0,
        description="share of the modelled joint friction at the reference rate fed forward",
    )


class CompensationConfig(Config):
    """Correction of the joint reference that keeps the end effector on its path."""

    bandwidth: float | None = Field(
        default=None,
        gt=0.0,
        le=100.0,
        description="rate at which an error is corrected, 1/s; null: by what the noise of the"
        " estimate costs, `noise_share`",
    )
    noise_share: float = Field(
        default=0.001,
        gt=0.0,
        le=1.0,
        description="moment that the noise of the estimate may cost through the arm, rms, as a"
        " share of the smallest moment that the thrusters have about an axis",
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
