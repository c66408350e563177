"""Parameters of the vehicle's control law, each with unit, bounds and meaning."""

from pydantic import Field

from uvms_control.allocator_config import LAG_COMPENSATION
from uvms_control.six import SixNotNegative, SixPositive
from uvms_core.config import Config


class GainConfig(Config):
    """Gains of the vehicle's default law: by rule from vehicle and sensors, or as given here."""

    bandwidth_rad_s: SixPositive | None = Field(
        default=None,
        description="natural frequency of the feedback near the reference, one per axis, rad/s;"
        " none: the largest that keeps the margins below (`uvms tune` prints it)",
    )
    damping_ratio: SixPositive | None = Field(
        default=None,
        description="damping ratio that the gains are laid out for, one per axis, no unit; none: by"
        " rule with the bandwidth, else 1",
    )
    authority_share: float = Field(
        default=0.8,
        gt=0.0,
        le=1.0,
        description="share of an axis's thrust that the feedback may ask for; the rest is for what"
        " is fed forward",
    )
    delay_margin_periods: float = Field(
        default=2.0,
        ge=0.0,
        le=20.0,
        description="further delay that the loop must bear, in control periods",
    )
    lag_compensation: float = Field(
        default=LAG_COMPENSATION,
        ge=0.0,
        le=1.0,
        description="share of the thrusters' lag that the allocator makes up for, for which the"
        " gains are laid out; in a scenario that of allocation.lag_compensation unless given",
    )
    external_bandwidth_rad_s: float | None = Field(
        default=None,
        gt=0.0,
        le=10.0,
        description="bandwidth of the observer's external wrench, for which the gains are laid out,"
        " rad/s; none: the observer's by rule; in a scenario that of"
        " observer.external_bandwidth_rad_s unless given",
    )
    noise_share: float = Field(
        default=0.01,
        gt=0.0,
        le=1.0,
        description="share of an axis's thrust that may go into following sensor noise, rms",
    )


class VehicleControlConfig(Config):
    """S-surface of the law `paper`: one value per axis (surge, sway, heave, roll, pitch, yaw)."""

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
