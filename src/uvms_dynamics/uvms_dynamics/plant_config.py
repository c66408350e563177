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
    """Joint angles (n,) at the start, rad; ConfigError for a wrong number or beyond a limit."""
    degrees = config.initial_joints_deg or vehicle.arm.stowed_deg
    if len(degrees) != vehicle.n_joints:
        raise ConfigError(
            f"initial_joints_deg: has {len(degrees)} values for {vehicle.n_joints} joints"
        )
    for joint, angle in zip(vehicle.arm.joints, degrees, strict=True):
        if not joint.lower_deg <= angle <= joint.upper_deg:
            raise ConfigError(
                f"initial_joints_deg: {angle:g} of joint {joint.name} is outside its limits"
                f" {joint.lower_deg:g} to {joint.upper_deg:g}"
            )
    return np.radians(degrees)


def check_step(vehicle: Vehicle, config: PlantConfig) -> None:
    """Raise ConfigError where the step is too long for a joint's friction or stop, or a thruster.

    A joint moves at least its rotor, so slope / rotor inertia bounds its eigenvalue from above.
    """
    for i, joint in enumerate(vehicle.arm.joints):
        where, rotor = f"arm.joints.{i} ({joint.name})", joint.rotor_inertia_kg_m2
        slope = joint.viscous_friction_nm_s
        slope += joint.coulomb_friction_nm / np.radians(joint.coulomb_width_deg_s)
        stop = np.sqrt(joint.stop_stiffness_nm_rad / rotor)
        friction = f"friction of {where} on its rotor inertia (raise coulomb_width_deg_s)"
        _check_rate(config, slope / rotor, _STABLE_REAL, friction)
        _check_rate(config, stop, _STABLE_IMAGINARY, f"stop_stiffness_nm_rad of {where}")
    for i, thruster in enumerate(vehicle.thrusters):
        lag = f"time_constant_s of thrusters.{i} ({thruster.name})"
        _check_rate(config, 1.0 / thruster.time_constant_s, _STABLE_REAL, lag)


def _check_rate(config: PlantConfig, rate: float, bound: float, cause: str) -> None:
    """Refuse a step that is unstable with an eigenvalue of this size, 1/s."""
    if config.step_s * rate > bound:
        raise ConfigError(
            f"step_s: {config.step_s:g} s is unstable with the {cause};"
            f" allowed: at most {bound / rate:.3g} s"
        )
