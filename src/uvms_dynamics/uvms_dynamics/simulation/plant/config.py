"""What a run of the plant starts from and how it is integrated."""

from typing import Any

import numpy as np
from pydantic import Field, model_validator

from uvms_core.errors import ConfigError
from uvms_core.signals import Array, to_nanoseconds
from uvms_core.start import StartConfig
from uvms_core.timing import CONTROL_PERIOD_S, ControlPeriod
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.plausible.extents import bare_hull_extent
from uvms_core.vehicle.postures import (
    STOWED,
    AnglesDeg,
    check_limits,
    joint_angles_deg,
    posture_deg,
)
from uvms_dynamics.kernels.rotations import quat_to_matrix, rpy_to_quat
from uvms_dynamics.simulation.integrator import JOINTS, QUATERNION, VELOCITY
from uvms_dynamics.simulation.plant.mismatch import Mismatch
from uvms_dynamics.simulation.water import CurrentConfig, velocity_at_start
from uvms_dynamics.simulation.water.airy import wave_length
from uvms_dynamics.simulation.water.currents import Speed, Turns


class PlantConfig(StartConfig):
    """Integration step, control period, start, water, and how the plant differs from the model."""

    step_s: float = Field(0.005, gt=0.0, le=0.05, description="Runge-Kutta step, s")
    control_period_s: ControlPeriod = CONTROL_PERIOD_S
    initial_rpy_deg: tuple[Turns, Turns, Turns] = Field(
        (0.0, 0.0, 0.0), description="roll, pitch, yaw (ZYX) at the start, degrees"
    )
    initial_velocity: tuple[Speed, Speed, Speed, Speed, Speed, Speed] = Field(
        (0.0,) * 6, description="velocity over ground at the start, body frame, m/s and rad/s"
    )
    initial_posture: str = Field(
        STOWED, description="posture of the vehicle file that the arm starts in, such as `home`"
    )
    initial_joints_deg: AnglesDeg = Field(
        (),
        description="joint angles at the start, degrees, instead of the posture's: one a joint, or"
        " by joint name for some; empty: the posture",
    )
    current_ned_m_s: tuple[Speed, Speed, Speed] = Field(
        (0.0, 0.0, 0.0),
        description="velocity of the water in map_ned, m/s: a short name of"
        " `current.constant_ned_m_s`",
    )
    current: CurrentConfig = Field(
        CurrentConfig(), description="how the water moves: the sum of what is given"
    )
    battery_charge: float = Field(
        1.0, ge=0.0, le=1.0, description="share of its charge that the battery has at the start"
    )
    vehicle_overrides: dict[str, Any] = Field(
        default_factory=dict,
        description="values of the vehicle file that only the plant has, by dotted path, such as"
        " `hull.cb_m: [0.0, 0.0024, 0.0]`; they come after `neutral` and `trim`, which do not see"
        " them, and the nodes go on with the nominal vehicle",
    )
    mismatch: Mismatch = Field(
        Mismatch(),
        description="how far the plant's vehicle may be from the nominal one, drawn by the seed",
    )

    @property
    def flow(self) -> CurrentConfig:
        """How the water moves, with the constant current under whichever name it is given."""
        if not any(self.current_ned_m_s):
            return self.current
        return self.current.model_copy(update={"constant_ned_m_s": self.current_ned_m_s})

    @model_validator(mode="after")
    def _one_constant_current(self) -> "PlantConfig":
        if any(self.current_ned_m_s) and any(self.current.constant_ned_m_s):
            raise ValueError(
                "current_ned_m_s is a short name of current.constant_ned_m_s: give only one of"
                f" {list(self.current_ned_m_s)} and {list(self.current.constant_ned_m_s)}"
            )
        return self

    @model_validator(mode="after")
    def _above_the_bottom(self) -> "PlantConfig":
        depth = self.initial_position_m[2]
        for i, wave in enumerate(self.current.waves):
            if depth >= wave.water_depth_m:
                raise ValueError(
                    f"current.waves.{i}.water_depth_m: {wave.water_depth_m:g} m is not below"
                    f" the start, which is {depth:g} m deep (initial_position_m)"
                )
        return self


SHORTEST_WAVE = 2.0
"""Length of a wave over that of the hull: in one as short the flow at the hull's centre is pi / 2
times its mean along the hull (1 / sinc(pi L / lambda)), and says no more of it."""


def check_waves(vehicle: Vehicle, config: PlantConfig) -> None:
    """Check the waves against hull and seabed.

    Raises:
        ConfigError: the seabed of the vehicle file is not the bottom that waves feel, or a wave is
            shorter than twice the hull, which takes the flow at its centre for all of it.
    """
    seabed = vehicle.environment.seabed_depth_m
    hull = 2.0 * bare_hull_extent(vehicle.hull).largest_m
    for i, wave in enumerate(config.current.waves):
        length = wave_length(wave.period_s, wave.water_depth_m)
        if length < SHORTEST_WAVE * hull:
            raise ConfigError(
                f"current.waves.{i}.period_s: a wave of {wave.period_s:g} s is {length:.3g} m long,"
                f" less than {SHORTEST_WAVE:g} times the hull's {hull:.3g} m; the hull takes the"
                " flow at its centre of buoyancy for all of it, which holds in long waves"
            )
        if seabed is not None and wave.water_depth_m != seabed:
            raise ConfigError(
                f"current.waves.{i}.water_depth_m: {wave.water_depth_m:g} m, but the vehicle's"
                f" environment.seabed_depth_m is {seabed:g} m: the sea has one depth"
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
    """Joint angles (n,) at the start, rad; raises as `initial_joints_deg`."""
    return np.radians(initial_joints_deg(vehicle, config))


def initial_joints_deg(vehicle: Vehicle, config: PlantConfig) -> tuple[float, ...]:
    """Joint angles (n,) at the start, degrees.

    Raises:
        ConfigError: an unknown posture or joint, a wrong number of values, or one beyond a limit.
    """
    try:
        posture = posture_deg(vehicle.arm, config.initial_posture)
    except ConfigError as fault:
        raise ConfigError(f"initial_posture: {fault}") from fault
    try:
        angles = joint_angles_deg(vehicle.arm, config.initial_joints_deg or posture, posture)
        check_limits(vehicle.arm.joints, angles)
    except ConfigError as fault:
        raise ConfigError(f"initial_joints_deg: {fault}") from fault
    return angles


def initial_state(vehicle: Vehicle, config: PlantConfig) -> Array:
    """State of the integrator at t = 0: joints at rest, no thrust."""
    state = np.zeros(JOINTS + 2 * vehicle.n_joints + vehicle.n_thrusters)
    quaternion = rpy_to_quat(*np.radians(config.initial_rpy_deg))
    state[:QUATERNION] = config.initial_position_m
    state[QUATERNION:VELOCITY] = quaternion
    state[VELOCITY:JOINTS] = config.initial_velocity
    state[VELOCITY : VELOCITY + 3] -= quat_to_matrix(quaternion).T @ velocity_at_start(config.flow)
    state[JOINTS : JOINTS + vehicle.n_joints] = initial_joints(vehicle, config)
    return state
