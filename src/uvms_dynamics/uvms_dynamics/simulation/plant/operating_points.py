"""States that a stable step must be able to integrate: at rest, at the stops, at top speed."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_core.vehicle.resistance import axis_resistance
from uvms_dynamics.kernels import inverse_dynamics
from uvms_dynamics.model import thruster_matrix
from uvms_dynamics.model.vehicle_table import Model
from uvms_dynamics.simulation.integrator import JOINTS, QUATERNION, VELOCITY
from uvms_dynamics.simulation.plant.config import PlantConfig, initial_state
from uvms_dynamics.simulation.plant.stiffest_poses import stiffest_poses, stop_depths
from uvms_dynamics.simulation.water import CurrentConfig
from uvms_dynamics.simulation.water.tables import greatest_speed

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
_LINEAR = 3  # so many of them are translations

_FASTEST = np.array([10.0] * _LINEAR + [2.0 * np.pi] * _LINEAR)
"""Bound of the top speed, m/s and rad/s, for hulls with hardly any damping."""


_ENTERING = 1e-2
"""Penetration of a joint that hits its stop, as a fraction of that under its full torque."""


class Point(NamedTuple):
    """A state (nx,) of the integrator, the joint torques (n,) that go with it, and what it is."""

    name: str
    state: Array
    effort: Array
    strikes: bool = False  # the stop begins within a step


def operating_points(vehicle: Vehicle, model: Model, config: PlantConfig) -> Iterator[Point]:
    """The start, rest in the stiffest pose, joints against their stops, and the greatest speeds.

    Unless stated otherwise the vehicle moves as it does at the start: in a current, with it.
    """
    start, stowed = initial_state(vehicle, config), np.radians(vehicle.arm.stowed_deg)
    rates = np.radians([joint.rate_limit_deg_s for joint in vehicle.arm.joints])
    stiffest = stiffest_poses(vehicle, model)
    yield _held(model, "at the start", start, len(stowed))
    yield _held(model, "with the arm stowed", with_joints(start, stowed), len(stowed))
    yield _held(model, _pose_name(stiffest.rest), with_joints(start, stiffest.rest), len(stowed))
    for q in stiffest.pressing:
        yield _against_stops(vehicle, start, q, pressing=True)
    for q in stiffest.striking:
        yield _against_stops(vehicle, start, q, pressing=False)
    moving = with_joints(start, stowed, rates)
    yield _held(model, "with the joints at their rate limits", moving, len(stowed))
    for name, state in _at_top_speed(vehicle, with_joints(start, stowed)):
        yield _held(model, name, state, len(stowed))
    for name, state in _in_fastest_water(config, with_joints(start, stowed)):
        yield _held(model, name, state, len(stowed))


def with_joints(state: Array, q: Array, q_dot: Array | float = 0.0) -> Array:
    """The state with other joint angles (n,) and rates."""
    n, result = len(q), state.copy()
    result[JOINTS : JOINTS + n] = q
    result[JOINTS + n : JOINTS + 2 * n] = q_dot
    return result


def _pose_name(q: Array) -> str:
    where = ", ".join(f"{angle:.0f}" for angle in np.degrees(q))
    return f"with the joints at rest at {where} degrees"


def _held(model: Model, name: str, state: Array, n: int) -> Point:
    """The point with the torques that keep the joints at their rates, friction left out."""
    nu_r, q, q_dot = state[VELOCITY:JOINTS], state[JOINTS : JOINTS + n], state[JOINTS + n :][:n]
    quaternion, still = state[QUATERNION:VELOCITY], np.zeros(n)
    force = inverse_dynamics(model, quaternion, nu_r, np.zeros(6), q, q_dot, still)
    return Point(name, state, force[6:])


def _against_stops(vehicle: Vehicle, start: Array, q: Array, pressing: bool) -> Point:
    """The joints that a pose has at a limit, pressed by their drives or hitting the stop."""
    joints = vehicle.arm.joints
    lower, upper = joint_limits(vehicle)
    side = 1.0 * (q >= upper) - 1.0 * (q <= lower)
    stopped = np.array([bool(joint.stop_stiffness_nm_rad) for joint in joints])
    at_stop = [joint.name for joint, at in zip(joints, side, strict=True) if at]
    names = "all joints" if len(at_stop) == len(joints) > 1 else ", ".join(at_stop)
    depths = side * stop_depths(vehicle)
    if pressing:
        effort = side * stopped * np.array([joint.effort_limit_nm for joint in joints])
        return Point(f"{names} pressed at effort_limit_nm", with_joints(start, q + depths), effort)
    rates = side * np.radians([joint.rate_limit_deg_s for joint in joints])
    state = with_joints(start, q + _ENTERING * depths, rates)
    return Point(f"{names} striking at the rate limit", state, np.zeros(len(q)), strikes=True)


def _at_top_speed(vehicle: Vehicle, rest: Array) -> Iterator[tuple[str, Array]]:
    """At the speed along each axis to which all thrusters drive the hull alone."""
    density = vehicle.environment.water_density_kg_m3
    linear, quadratic = axis_resistance(vehicle.hull, density)
    limits = [thruster.greatest_n for thruster in vehicle.thrusters]
    push = np.abs(thruster_matrix(vehicle)) @ limits
    for k, axis in enumerate(AXES):
        speed = _terminal_speed(push[k], float(linear[k]), float(quadratic[k]))
        if not speed:
            continue
        state = rest.copy()
        state[VELOCITY:JOINTS] = 0.0
        state[VELOCITY + k] = speed = min(speed, _FASTEST[k])
        unit = "m/s" if k < _LINEAR else "rad/s"
        yield f"at {speed:.3g} {unit} of {axis}", state


def _in_fastest_water(config: PlantConfig, rest: Array) -> Iterator[tuple[str, Array]]:
    """Held against the greatest flow along each axis, where it is not that of the start."""
    flow = config.flow
    if flow == CurrentConfig(constant_ned_m_s=flow.constant_ned_m_s):
        return
    speed = greatest_speed(flow)
    for k, axis in enumerate(AXES[:_LINEAR]):
        state = rest.copy()
        state[VELOCITY:JOINTS] = 0.0
        state[VELOCITY + k] = speed
        yield f"in water of {speed:.3g} m/s along {axis}", state


def _terminal_speed(force: float, linear: float, quadratic: float) -> float:
    """Speed where the damping d v + d' v^2 is as great as the force; 0 without damping."""
    if force <= 0.0 or linear + quadratic <= 0.0:
        return 0.0
    return 2.0 * force / (linear + float(np.sqrt(linear**2 + 4.0 * quadratic * force)))
