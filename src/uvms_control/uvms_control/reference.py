"""A planned reference at one instant: interpolation between its samples.

Positions and joints follow cubic Hermite polynomials, attitude the same polynomial in the
rotation vector from the earlier sample; velocities are their derivatives, accelerations run
linearly between the samples. At a sample every value is exactly the planner's. Outside the
reference the nearest end is held at rest.
"""

from dataclasses import dataclass, replace

import numpy as np

from uvms_core.signals import Array, Reference, to_nanoseconds, to_seconds
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    rotation_vector_to_quat,
    skew,
)

SMALL_ANGLE = 1e-4  # rad; below it the series of the right Jacobian are exact to rounding


@dataclass(frozen=True)
class ReferenceSample:
    """Desired motion of vehicle and joints at one instant; frames as in `Reference`."""

    position: Array  # (3,)
    quaternion: Array  # (4,)
    nu: Array  # (6,) in the desired body frame
    nu_dot: Array  # (6,) body-frame derivative of nu
    q: Array  # (n,)
    q_dot: Array  # (n,)
    q_ddot: Array  # (n,)
    end_effector: Array  # (3,)


def sample_reference(reference: Reference, stamp: int) -> ReferenceSample:
    """The reference at `stamp` (ns); held at rest before its first and after its last sample."""
    since = stamp - reference.stamp
    if since < 0:
        return _at_rest(reference, 0)
    if stamp > reference.end:
        return _at_rest(reference, -1)
    t = to_seconds(since)
    nearest = int(np.argmin(np.abs(reference.times - t)))
    if to_nanoseconds(float(reference.times[nearest])) == since:
        return _sample(reference, nearest)
    return _between(reference, int(np.searchsorted(reference.times, t, side="right")) - 1, t)


def sample_ahead(reference: Reference, stamp: int, lead: int) -> ReferenceSample:
    """The joints and accelerations `lead` ns after a stamp, as far as they are planned.

    Beyond the last sample the joints go on with its velocity: the next reference takes over within
    a few ticks, and to stop them there would be the greater error.
    """
    at = max(min(stamp + lead, reference.end), reference.stamp)
    sample, beyond = sample_reference(reference, at), to_seconds(stamp + lead - at)
    return replace(sample, q=sample.q + max(beyond, 0.0) * sample.q_dot)


def _sample(reference: Reference, i: int) -> ReferenceSample:
    return ReferenceSample(
        reference.position[i],
        reference.quaternion[i],
        reference.nu[i],
        reference.nu_dot[i],
        reference.q[i],
        reference.q_dot[i],
        reference.q_ddot[i],
        reference.end_effector[i],
    )


def _at_rest(reference: Reference, i: int) -> ReferenceSample:
    zero_joints = np.zeros_like(reference.q[i])
    return ReferenceSample(
        reference.position[i],
        reference.quaternion[i],
        np.zeros(6),
        np.zeros(6),
        reference.q[i],
        zero_joints,
        zero_joints,
        reference.end_effector[i],
    )


def _between(reference: Reference, i: int, t: float) -> ReferenceSample:
    h = float(reference.times[i + 1] - reference.times[i])
    s = (t - float(reference.times[i])) / h
    quaternion, omega = _hermite_attitude(reference, i, s, h)
    v_world = [quat_to_matrix(reference.quaternion[k]) @ reference.nu[k, :3] for k in (i, i + 1)]
    position, velocity = _hermite(
        reference.position[i], reference.position[i + 1], v_world[0], v_world[1], s, h
    )
    q, q_dot = _hermite(
        reference.q[i], reference.q[i + 1], reference.q_dot[i], reference.q_dot[i + 1], s, h
    )
    v_body = quat_to_matrix(quaternion).T @ velocity
    return ReferenceSample(
        position,
        quaternion,
        np.concatenate((v_body, omega)),
        _linear(reference.nu_dot, i, s),
        q,
        q_dot,
        _linear(reference.q_ddot, i, s),
        _linear(reference.end_effector, i, s),
    )


def _linear(values: Array, i: int, s: float) -> Array:
    return (1.0 - s) * values[i] + s * values[i + 1]


def _hermite(x0: Array, x1: Array, v0: Array, v1: Array, s: float, h: float) -> tuple[Array, Array]:
    """Cubic Hermite polynomial and its time derivative at the share s of an interval h."""
    d = x1 - x0
    x = x0 + s * s * (3.0 - 2.0 * s) * d + s * (1.0 - s) * h * ((1.0 - s) * v0 - s * v1)
    v = 6.0 * s * (1.0 - s) * d / h + (1.0 - s) * (1.0 - 3.0 * s) * v0 + s * (3.0 * s - 2.0) * v1
    return x, v


def _hermite_attitude(reference: Reference, i: int, s: float, h: float) -> tuple[Array, Array]:
    """Attitude and angular velocity (body frame) between samples i and i + 1."""
    start, end = reference.quaternion[i], reference.quaternion[i + 1]
    turn = quat_to_rotation_vector(quat_multiply(quat_conjugate(start), end))
    rate_start = reference.nu[i, 3:]
    rate_end = np.asarray(np.linalg.solve(right_jacobian(turn), reference.nu[i + 1, 3:]), float)
    phi, phi_dot = _hermite(np.zeros(3), turn, rate_start, rate_end, s, h)
    quaternion = quat_multiply(start, rotation_vector_to_quat(phi))
    return quaternion / np.linalg.norm(quaternion), right_jacobian(phi) @ phi_dot


def right_jacobian(phi: Array) -> Array:
    """J_r(phi) (3, 3): body angular velocity = J_r(phi) d(phi)/dt for R = exp([phi]x).

    I - (1 - cos a) / a^2 [phi]x + (a - sin a) / a^3 [phi]x^2 with a = |phi| (Chirikjian,
    Stochastic Models, Information Theory, and Lie Groups, vol. 2, eq. (10.86)).
    """
    angle = float(np.linalg.norm(phi))
    cross = skew(phi)
    if angle < SMALL_ANGLE:
        return np.eye(3) - 0.5 * cross + cross @ cross / 6.0
    first = (1.0 - np.cos(angle)) / angle**2
    second = (angle - np.sin(angle)) / angle**3
    return np.eye(3) - first * cross + second * cross @ cross
