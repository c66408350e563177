"""Poses of the arm in which friction and stops act on the least inertia, and so the fastest.

How easily the joints move is M(q)^-1, which hull, arm and water make very different from pose to
pose. Poses are tried out, evenly over the joints' ranges; only M(q) is needed for that.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, joint_limits
from uvms_dynamics.kernels import mass_matrix
from uvms_dynamics.model.vehicle_table import Model

_TRIED, _ANGLES = 256, 2048
"""Most poses that are tried, and most joint angles in all: long arms take long for each."""

_BEYOND = 1.5
"""Poses are spread over so many times the joints' ranges and cut: many have joints at a limit."""


class StiffestPoses(NamedTuple):
    """Joint angles (n,) each; in the stops' poses those joints are at a limit that are meant."""

    rest: Array  # friction
    pressing: tuple[Array, Array]  # friction and dissipation: one joint in its stop, or all
    striking: tuple[Array, Array]  # stiffness of the stops: one joint, or all


def stiffest_poses(vehicle: Vehicle, model: Model) -> StiffestPoses:
    """The stiffest of the poses that are tried, by the greatest eigenvalue of M^-1 D or M^-1 K."""
    joints = vehicle.arm.joints
    friction = np.array(
        [
            j.viscous_friction_nm_s + j.coulomb_friction_nm / np.radians(j.coulomb_width_deg_s)
            for j in joints
        ]
    )
    dissipation = np.array([j.stop_dissipation_s_rad * j.effort_limit_nm for j in joints])
    stiffness = np.array(
        [
            j.stop_stiffness_nm_rad
            * (1.0 + j.stop_dissipation_s_rad * np.radians(j.rate_limit_deg_s))
            for j in joints
        ]
    )
    stopped = np.where(stiffness > 0.0, friction + dissipation, 0.0)
    anywhere, corners = _poses(vehicle)
    free, cornered = _mobility(model, anywhere), _mobility(model, corners)
    return StiffestPoses(
        anywhere[_stiffest(free, friction)],
        (_one(vehicle, anywhere, free, stopped), corners[_stiffest(cornered, stopped)]),
        (_one(vehicle, anywhere, free, stiffness), corners[_stiffest(cornered, stiffness)]),
    )


def _poses(vehicle: Vehicle) -> tuple[Array, Array]:
    """Joint angles (k, n) anywhere, and with all joints at a limit; the same at every call.

    Multiples of the square roots of integers fill the cube evenly (Weyl).
    """
    lower, upper = joint_limits(vehicle)
    step = np.sqrt(np.arange(2.0, 2.0 + len(lower))) + np.sqrt(5.0)
    tried = min(_TRIED, max(1, _ANGLES // len(lower)))
    part = np.outer(np.arange(1, tried + 1), step) % 1.0
    spread = np.clip(0.5 + _BEYOND * (part - 0.5), 0.0, 1.0)
    return lower + spread * (upper - lower), np.where(part < 0.5, lower, upper)


def _mobility(model: Model, poses: Array) -> Array:
    """Joint accelerations per torque (k, n, n), the vehicle free to move."""
    matrices = np.array([mass_matrix(model, np.ascontiguousarray(q)) for q in poses])
    return np.linalg.inv(matrices)[:, 6:, 6:]


def _stiffest(mobility: Array, slope: Array) -> int:
    """Which pose has the greatest eigenvalue of mobility times diag(slope)."""
    root = np.sqrt(slope)
    return int(np.argmax(np.linalg.eigvalsh(mobility * root[:, None] * root)[:, -1]))


def _one(vehicle: Vehicle, poses: Array, mobility: Array, slope: Array) -> Array:
    """The pose in which one joint alone is the fastest, with that joint at its nearer limit."""
    rates = np.diagonal(mobility, axis1=1, axis2=2) * slope
    k, i = np.unravel_index(int(np.argmax(rates)), rates.shape)
    lower, upper = joint_limits(vehicle)
    margin = 1e-3 * (upper - lower)  # the others stay clear of their stops
    q = np.clip(poses[k], lower + margin, upper - margin)
    q[i] = upper[i] if poses[k, i] > 0.5 * (lower[i] + upper[i]) else lower[i]
    return q


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
