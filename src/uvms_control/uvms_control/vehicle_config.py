"""Parameters of the vehicle's control law, each with unit, bounds and meaning."""

from pydantic import Field

from uvms_control.six import SixNotNegative, SixPositive
from uvms_core.config import Config


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
