"""States of the plant that a step must be able to integrate: at rest, at its stops, at speed."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from uvms_dynamics.integrator import JOINTS, VELOCITY
from uvms_dynamics.plant_config import PlantConfig, initial_state
from uvms_dynamics.signals import Array
from uvms_dynamics.thrusters import thruster_matrix
from uvms_dynamics.vehicle import Vehicle

AXES = ("surge", "sway", "heave", "roll", "pitch", "yaw")
_LINEAR = 3  # so many of them are translations

_POSES = 6
"""Arm poses, spread evenly over the joints' ranges, besides the stowed one and the start."""

_FASTEST = np.array([10.0] * _LINEAR + [2.0 * np.pi] * _LINEAR)
"""Bound of the top speed, m/s and rad/s: no hull gets there that has next to no damping."""


class Point(NamedTuple):
    """A state (nx,) of the integrator, the joint torques (n,) that go with it, and what it is."""

    name: str
    state: Array
    effort: Array


def operating_points(vehicle: Vehicle, config: PlantConfig) -> Iterator[Point]:
    """The start, rest in several poses, joints against their stops, and the greatest speeds."""
    idle = np.zeros(vehicle.n_joints)
    yield Point("at the start", initial_state(vehicle, config), idle)
    stowed = np.radians(vehicle.arm.stowed_deg)
    yield Point("at rest with the arm stowed", _state(vehicle, stowed), idle)
    for q in _poses(vehicle):
        where = ", ".join(f"{angle:.0f}" for angle in np.degrees(q))
        yield Point(f"at rest with the joints at {where} degrees", _state(vehicle, q), idle)
    yield from _against_the_stops(vehicle)
    rates = np.radians([joint.rate_limit_deg_s for joint in vehicle.arm.joints])
    yield Point("with the joints at their rate limits", _state(vehicle, stowed, rates), idle)
    yield from _at_top_speed(vehicle, stowed)


def _state(vehicle: Vehicle, q: Array, q_dot: Array | float = 0.0) -> Array:
    """Level and at rest in the water."""
    n = vehicle.n_joints
    state = np.zeros(JOINTS + 2 * n + vehicle.n_thrusters)
    state[VELOCITY - 1] = 1.0
    state[JOINTS : JOINTS + n] = q
    state[JOINTS + n : JOINTS + 2 * n] = q_dot
    return state


def _poses(vehicle: Vehicle) -> Array:
    """Joint angles (_POSES, n): an additive recurrence, the same at every call.

    Multiples of the square roots of primes fill the cube evenly (Weyl).
    """
    joints = vehicle.arm.joints
    lower = np.radians([joint.lower_deg for joint in joints])
    upper = np.radians([joint.upper_deg for joint in joints])
    step = np.sqrt(np.arange(2.0, 2.0 + len(joints))) + np.sqrt(5.0)
    return lower + (np.outer(np.arange(1, _POSES + 1), step) % 1.0) * (upper - lower)


def _against_the_stops(vehicle: Vehicle) -> Iterator[Point]:
    """All joints pressed by their drives, and driven in at their rate limits, at either end."""
    for sign, end in ((1.0, "upper"), (-1.0, "lower")):
        effort = sign * np.array(
            [j.effort_limit_nm if j.stop_stiffness_nm_rad else 0.0 for j in vehicle.arm.joints]
        )
        limit = np.radians([getattr(joint, f"{end}_deg") for joint in vehicle.arm.joints])
        q = limit + sign * stop_depths(vehicle)
        rates = sign * np.radians([joint.rate_limit_deg_s for joint in vehicle.arm.joints])
        name = f"the joints against their {end} stops"
        yield Point(f"pressing {name} at effort_limit_nm", _state(vehicle, q), effort)
        yield Point(f"driving {name} at their rate limits", _state(vehicle, q, rates), effort)


def stop_depths(vehicle: Vehicle) -> Array:
    """How far (n,) each drive presses its joint into a stop at rest, rad; 0 where none is."""
    return np.array(
        [
            joint.effort_limit_nm / joint.stop_stiffness_nm_rad
            if joint.stop_stiffness_nm_rad
            else 0.0
            for joint in vehicle.arm.joints
        ]
    )


def _at_top_speed(vehicle: Vehicle, q: Array) -> Iterator[Point]:
    """Through the water along each axis as fast as all thrusters push the hull alone."""
    hull = vehicle.hull
    limits = [thruster.limit_n for thruster in vehicle.thrusters]
    push = np.abs(thruster_matrix(vehicle)) @ limits
    for k, axis in enumerate(AXES):
        speed = _terminal_speed(push[k], hull.linear_damping[k], hull.quadratic_damping[k])
        if not speed:
            continue
        state = _state(vehicle, q)
        state[VELOCITY + k] = speed = min(speed, _FASTEST[k])
        unit = "m/s" if k < _LINEAR else "rad/s"
        yield Point(f"at {speed:.3g} {unit} of {axis}", state, np.zeros(len(q)))


def _terminal_speed(force: float, linear: float, quadratic: float) -> float:
    """Speed where the damping d v + d' v^2 is as great as the force; 0 without damping."""
    if force <= 0.0 or linear + quadratic <= 0.0:
        return 0.0
    return 2.0 * force / (linear + float(np.sqrt(linear**2 + 4.0 * quadratic * force)))
