"""What a run of the plant starts from and how it is integrated."""

import numpy as np
from pydantic import Field

from uvms_dynamics.config import Config
from uvms_dynamics.errors import ConfigError
from uvms_dynamics.signals import Array, to_nanoseconds
from uvms_dynamics.vehicle import Vehicle

_STABLE_REAL, _STABLE_IMAGINARY = 2.78, 2.82
"""Where classical Runge-Kutta is stable: |step x eigenvalue| on the real and imaginary axis
(Hairer and Wanner 1996, sec. IV.2)."""


class PlantConfig(Config):
    """Integration step, control period, start and current."""

    step_s: float = Field(0.005, gt=0.0, le=0.05, description="Runge-Kutta step, s")
    control_period_s: float = Field(
        0.05, gt=0.0, le=1.0, description="time between commands, a multiple of step_s, s"
    )
    initial_position_m: tuple[float, float, float] = Field(
        (0.0, 0.0, 10.0), description="of the body origin in map_ned, m"
    )
    initial_rpy_deg: tuple[float, float, float] = Field(
        (0.0, 0.0, 0.0), description="roll, pitch, yaw (ZYX), degrees"
    )
    initial_velocity: tuple[float, float, float, float, float, float] = Field(
        (0.0,) * 6, description="nu over ground, body frame, m/s and rad/s"
    )
    initial_joints_deg: tuple[float, ...] = Field(
        (), description="joint angles, degrees; empty: the vehicle's stowed pose"
    )
    current_ned_m_s: tuple[float, float, float] = Field(
        (0.0, 0.0, 0.0), description="velocity of the water in map_ned, m/s"
    )


def steps_in(period: int, config: PlantConfig, what: str) -> int:
    """How many plant steps a period (ns) holds; ConfigError unless it is a whole number."""
    step = to_nanoseconds(config.step_s)
    if period < step or period % step:
        raise ConfigError(
            f"{what}: its period of {period / 1e9:g} s must be a multiple of"
            f" step_s = {config.step_s:g} s"
        )
    return period // step


def initial_joints(vehicle: Vehicle, config: PlantConfig) -> Array:
    """Joint angles (n,) at the start, rad; ConfigError for a wrong number of them."""
    degrees = config.initial_joints_deg or vehicle.arm.stowed_deg
    if len(degrees) != vehicle.n_joints:
        raise ConfigError(
            f"initial_joints_deg: has {len(degrees)} values for {vehicle.n_joints} joints"
        )
    return np.radians(degrees)


def check_step(vehicle: Vehicle, config: PlantConfig) -> None:
    """Raise ConfigError where a joint's friction or stop is too stiff for the integration step.

    A joint moves at least its rotor, so slope / rotor inertia bounds its eigenvalue from above.
    """
    for i, joint in enumerate(vehicle.arm.joints):
        slope = joint.viscous_friction_nm_s
        slope += joint.coulomb_friction_nm / np.radians(joint.coulomb_width_deg_s)
        damping = config.step_s * slope / joint.rotor_inertia_kg_m2
        stop = config.step_s * np.sqrt(joint.stop_stiffness_nm_rad / joint.rotor_inertia_kg_m2)
        for value, bound, cause in (
            (damping, _STABLE_REAL, "friction (raise coulomb_width_deg_s)"),
            (stop, _STABLE_IMAGINARY, "stop_stiffness_nm_rad"),
        ):
            if value > bound:
                raise ConfigError(
                    f"step_s: {config.step_s:g} s is unstable with the {cause} of"
                    f" arm.joints.{i} ({joint.name}) on its rotor inertia;"
                    f" allowed: at most {config.step_s * bound / value:.3g} s"
                )
