"""How large and how fast things of a vehicle can be: the numbers that its bounds come from."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle

SPEEDS_M_S = (10.0, 50.0)
"""Every vehicle is granted the first (5 m/s through the water, in a current and surge of as much);
none gets the second, which no body under water reaches without a rocket."""
RATES_RAD_S = (20.0, 60.0)
"""The same for its rates of turn: three turns a second when it tumbles, ten for none."""
OVERWEIGHT = 10.0
"""A vehicle may be this many times heavier than its file says: a payload, or a slip in the file."""
TERMINAL = 3.0
"""Factor on terminal speeds: drag coefficients are known to a factor of a few."""
JOINT_RATES = 20.0
"""Factor on a joint's rate limit, which is the drive's: a joint that is pushed turns faster."""
JOINT_RATE_RAD_S = 30.0
"""Granted to every joint: what a light last link gets to when it is let go."""
FASTEST_JOINT_RAD_S = 100.0
"""Granted to none: a geared drive does not turn a thousand times a minute."""


@dataclass(frozen=True)
class Scale:
    """Greatest values of a vehicle's motion and load, SI units."""

    speed: float  # m/s, over ground, along any axis
    rate: float  # rad/s, about any axis
    size: float  # m, from the body origin to the farthest part
    force: float  # N: all thrusters together
    weight: float  # N: vehicle and arm, in air
    joint_rate: Array  # (n,) rad/s
    effort: Array  # (n,) N m


def scale_of(vehicle: Vehicle) -> Scale:
    """The greatest values of a vehicle."""
    hull, joints = vehicle.hull, vehicle.arm.joints
    gravity = vehicle.environment.gravity_m_s2
    mass = hull.mass_kg + sum(link.mass_kg for link in vehicle.arm.links)
    force = sum(thruster.greatest_n for thruster in vehicle.thrusters)
    size = _size(vehicle)
    load = force + OVERWEIGHT * mass * gravity
    linear = diagonal(hull.linear_damping), diagonal(hull.quadratic_damping)
    speed = TERMINAL * float(np.max(_terminal(load, linear[0][:3], linear[1][:3])))
    rate = TERMINAL * float(np.max(_terminal(load * size, linear[0][3:], linear[1][3:])))
    limits = np.radians([joint.rate_limit_deg_s for joint in joints])
    # A drive at full torque against its friction alone, with nothing beyond it.
    with np.errstate(divide="ignore"):
        friction = np.array([joint.viscous_friction_nm_s for joint in joints])
        free = np.array([joint.effort_limit_nm for joint in joints]) / friction
    fastest = FASTEST_JOINT_RAD_S
    return Scale(
        speed=float(np.clip(speed, *SPEEDS_M_S)),
        rate=float(np.clip(rate, *RATES_RAD_S)),
        size=size,
        force=force,
        weight=mass * gravity,
        joint_rate=np.clip(np.maximum(JOINT_RATES * limits, free), JOINT_RATE_RAD_S, fastest),
        effort=np.array([joint.effort_limit_nm for joint in joints]),
    )


def _terminal(load: float, linear: Array, quadratic: Array) -> Array:
    """Speeds at which d v + D v^2 balances the load; infinite without damping."""
    with np.errstate(divide="ignore", invalid="ignore"):
        square = np.sqrt(load / quadratic)
        line = load / linear
    return np.minimum(np.nan_to_num(square, nan=np.inf), np.nan_to_num(line, nan=np.inf))


def diagonal(matrix: object) -> Array:
    """Magnitudes of a matrix's diagonal, which a file may give alone."""
    values = np.abs(np.asarray(matrix, dtype=float))
    return values.diagonal() if values.ndim == 2 else values


def _size(vehicle: Vehicle) -> float:
    """Reach of thrusters, sensors and the stretched arm; a metre at least."""
    places = [thruster.position_m for thruster in vehicle.thrusters]
    places += [sensor.position_m for sensor in vehicle.sensors.mounted.values()]
    return max(1.0, reach_of(vehicle), *(float(np.linalg.norm(place)) for place in places))


def reach_of(vehicle: Vehicle) -> float:
    """Distance of the stretched arm's tool from the body origin at most, m."""
    reach = float(np.linalg.norm(vehicle.arm.base.position_m))
    reach += float(np.linalg.norm(vehicle.arm.tool.position_m))
    for joint in vehicle.arm.joints:
        if joint.origin is not None:
            reach += float(np.linalg.norm(joint.origin.position_m))
        else:
            reach += float(np.hypot(joint.a_m or 0.0, joint.d_m or 0.0))
    return reach
