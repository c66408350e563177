"""Attitude from gravity and a heading, where the inertial unit measures none.

At rest the specific force is f = R^T (0, 0, -g), so that (Titterton and Weston 2004, sec. 10.2)

    roll = atan2(-f_y, -f_z),   pitch = atan2(f_x, sqrt(f_y^2 + f_z^2)).

A vehicle that moves accelerates a little; the attitude is as uncertain as that makes it.
"""

from dataclasses import replace
from itertools import product

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.sensors.mounting import mounting_of
from uvms_core.signals import Array, ImuSample
from uvms_core.vehicle.sensors import Imu
from uvms_observer.navigation.inertial.unknown_motion import ACCELERATION_M_S2

WRONG_WAY_DEG = 45.0
"""Angle between the measured up and the true one beyond which it is no motion of a vehicle: that
would take an acceleration of gravity's size."""
SIZE = (0.5, 1.5)
"""Size of the specific force, over gravity's, at which a unit without attitude can be levelled."""
AT_REST = 0.1
"""Share of gravity by which the specific force of a unit at rest, or nearly so, may be off it: a
large bias and the swing of waves. Beyond, the vehicle is being pushed, and one sample tells nothing
of how the unit is mounted."""


def level(force: Array, heading: float = 0.0) -> Array:
    """Attitude (4,) of a unit at rest that measures this specific force (3,), body axes."""
    roll = np.arctan2(-force[1], -force[2])
    pitch = np.arctan2(force[0], np.hypot(force[1], force[2]))
    quaternion: Array = rpy_to_quat(roll, pitch, heading)
    return quaternion


def level_variance(gravity: float, noise: float, bias_variance: float) -> float:
    """Variance of roll and of pitch so found, rad^2."""
    return (ACCELERATION_M_S2**2 + noise**2 + bias_variance) / gravity**2


def check_gravity(name: str, section: Imu, sample: ImuSample, gravity: float) -> None:
    """Whether an inertial unit that starts feels gravity as it should.

    Args:
        name: of the unit's section in the vehicle file.
        section: that section.
        sample: its first one, turned as the file declares.
        gravity: m/s^2.

    A unit that measures its attitude may start in any motion, even in a violent one.

    Raises:
        SignalError: it does not; says which field of the vehicle file would make it.
    """
    force, R = sample.linear_acceleration, _attitude(sample)
    size = float(np.linalg.norm(force)) / gravity
    if _is_no_motion(size, gravity) or not (sample.oriented or SIZE[0] <= size <= SIZE[1]):
        raise SignalError(
            f"{name}.linear_acceleration: has the size of {size:.3g} g; at rest it must be the"
            " specific force, 1 g upwards, in m/s^2 (not in g, and gravity not taken off)"
        )
    moves = sample.oriented and abs(size - 1.0) > AT_REST
    if moves or _tilt_deg(R @ force) <= WRONG_WAY_DEG:
        return
    raise SignalError(
        f"{name}.linear_acceleration: {np.round(force, 2).tolist()} m/s^2 in body axes points"
        f" {_tilt_deg(R @ force):.0f} deg away from up, and the unit at rest must feel gravity"
        f" upwards (forward-right-down: [0, 0, -{gravity:.2f}] when level)."
        f" {_advice(name, section, sample)}"
    )


def _is_no_motion(size: float, gravity: float) -> bool:
    """Whether a force of this size over gravity's is rather 1 in units of g, or without gravity."""
    return abs(size * gravity - 1.0) <= AT_REST or size <= 0.5 * AT_REST


def _attitude(sample: ImuSample) -> Array:
    return quat_to_matrix(sample.quaternion) if sample.oriented else np.eye(3)


def _tilt_deg(up: Array) -> float:
    """Angle of a direction (3,), map_ned, from straight up."""
    return float(np.degrees(np.arccos(np.clip(-up[2] / np.linalg.norm(up), -1.0, 1.0))))


def _advice(name: str, section: Imu, sample: ImuSample) -> str:
    """The declarations with which it would fit, the vehicle upright."""
    before = mounting_of(section)
    for axes, world in product(("frd", "flu"), ("ned", "enu")):
        after = replace(before, axes=axes, world=world)
        turn = after.to_body @ before.to_body.T
        R = np.eye(3)
        if sample.oriented:
            world_turn = quat_to_matrix(after.to_ned) @ quat_to_matrix(before.to_ned)
            R = world_turn @ _attitude(sample) @ turn.T
        if _tilt_deg(R @ turn @ sample.linear_acceleration) <= WRONG_WAY_DEG and R[2, 2] > 0.0:
            changes = [
                f"sensors.{name}.{field}: {new}"
                for field, new in (("axes", axes), ("world", world))
                if new != getattr(before, field)
            ]
            return f"It would fit with {' and '.join(changes)} in the vehicle file"
    return f"Look at sensors.{name}.axes, world and rpy_deg in the vehicle file"
