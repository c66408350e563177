"""The moving water around the vehicle at one state, for what Python asks of it beside the plant."""

from typing import Any, NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.layout import HULL
from uvms_dynamics.kernels.layout import JOINTS as JOINTS_COUNT
from uvms_dynamics.kernels.motion import make_workspace, set_angle
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.integrator import JOINTS, QUATERNION, VELOCITY, System
from uvms_dynamics.simulation.water.stream import stream_at
from uvms_dynamics.simulation.water.waves import spread_waves, wave_motion_at


class Surroundings(NamedTuple):
    """Flow at a state: that of the frame that nu_r is relative to, and of waves at the bodies."""

    velocity: Array  # (3,) of the frame, world
    acceleration: Array  # (3,) of the frame, world
    tilt: Array  # (3,) what its acceleration A adds to down, body axes: -A / g
    down: Array  # (3,) as weight and buoyancy act in the frame, body axes
    orbital: (
        Array  # (6,) velocity and acceleration by waves at the hull's centre of buoyancy, world
    )
    wet: Array | None  # of `kernels.waves`; None where the flow is uniform
    hull: Array  # (4,) displaced mass and centre of buoyancy of the hull


def frame_velocity(system: System, time: float) -> Array:
    """Velocity (3,) in the world of the frame that nu_r is relative to, at a time, s."""
    if system.water is None:
        return system.current
    return system.current + stream_at(system.water, np.array([time]))[0, :3]


def surroundings(system: System, x: Array, time: float) -> Surroundings | None:
    """Of the integrator's state x (nx,) at a time, s; None in a constant current."""
    water = system.water
    if water is None:
        return None
    quat = x[QUATERNION:VELOCITY] / np.linalg.norm(x[QUATERNION:VELOCITY])
    to_body = quat_to_matrix(quat).T
    moving = stream_at(water, np.array([time]))[0]
    velocity, acceleration = system.current + moving[:3], moving[3:]
    tilt = -(to_body @ acceleration) / water.gravity
    wet, orbital = None, np.zeros(6)
    if water.waves is not None and water.bodies is not None:
        wet = water.bodies.copy()
        _spread(system.model, water, wet, x, quat, velocity, time)
        centre = x[:3] + water.hull[1:] @ to_body
        orbital = wave_motion_at(water.waves, centre[None], velocity[None], np.array([time]))[0]
    down = to_body[:, 2] + tilt
    return Surroundings(velocity, acceleration, tilt, down, orbital, wet, water.hull)


@kernel
def _spread(model: Any, water: Any, wet: Any, x: Any, quat: Any, velocity: Any, time: Any) -> None:
    """Set the flow in `wet` to that at each body."""
    n, work = np.int64(model[HULL, JOINTS_COUNT]), make_workspace(model)
    for i in range(1, n + 1):
        set_angle(model, work, i, x[JOINTS + i - 1])
    attitude, place = (quat[0], quat[1], quat[2], quat[3]), (x[0], x[1], x[2])
    drift = velocity[0], velocity[1], velocity[2]
    spread_waves(model, water, wet, work, n, place, attitude, drift, time)
