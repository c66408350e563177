"""A planned reference at one instant: interpolation between its samples.

Positions and joints follow cubic Hermite polynomials, attitude the same polynomial in the
rotation vector from the earlier sample; velocities are their derivatives, accelerations run
linearly between the samples. At a sample every value is exactly the planner's. Outside the
reference the nearest end is held at rest.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array, Reference, to_nanoseconds, to_seconds
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.products import product, squared, transposed_product
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    rotation_vector_to_quat,
    skew,
)

SMALL_ANGLE = 1e-4  # rad; below it the series of the right Jacobian are exact to rounding

# Columns of a sample in one row: vehicle and end effector, then angles, rates, accelerations of the
# joints. `JOINTS` is the first of those.
POSITION, QUATERNION, NU, NU_DOT, END_EFFECTOR, JOINTS = 0, 3, 7, 13, 19, 22


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


class PlannedMotion:
    """A reference as one table, made once for all the ticks that it covers."""

    def __init__(self, reference: Reference) -> None:
        self._begin, self._end = reference.stamp, reference.end
        self._stamps = np.array([to_nanoseconds(float(t)) for t in reference.times], np.int64)
        # As a message has them, in whole nanoseconds: on the graph and in the process the same.
        self._times = np.array([to_seconds(int(stamp)) for stamp in self._stamps])
        self._n = reference.q.shape[1]
        self._table = np.hstack(
            (
                reference.position,
                reference.quaternion,
                reference.nu,
                reference.nu_dot,
                reference.end_effector,
                reference.q,
                reference.q_dot,
                reference.q_ddot,
            )
        )

    def row(self, stamp: int) -> Array:
        """All values (22 + 3 n,) at a stamp, ns; at rest before the first and after the last."""
        return planned_row(self._stamps, self._times, self._table, stamp - self._begin)

    def row_ahead(self, stamp: int, lead: int) -> Array:
        """The values `lead` ns after a stamp, as far as they are planned.

        Beyond the last sample the joints go on with its velocity: the next reference takes over
        within a few ticks, and to stop them there would be the greater error.
        """
        at = max(min(stamp + lead, self._end), self._begin)
        row = self.row(at)
        if (beyond := to_seconds(stamp + lead - at)) > 0.0:
            q, rates = JOINTS, JOINTS + self._n
            row[q:rates] += beyond * row[rates : rates + self._n]
        return row

    def sample(self, row: Array) -> ReferenceSample:
        """The values of a row by their names."""
        q, rates, accelerations = (JOINTS + k * self._n for k in range(3))
        return ReferenceSample(
            row[POSITION:QUATERNION],
            row[QUATERNION:NU],
            row[NU:NU_DOT],
            row[NU_DOT:END_EFFECTOR],
            row[q:rates],
            row[rates:accelerations],
            row[accelerations:],
            row[END_EFFECTOR:JOINTS],
        )


def sample_reference(reference: Reference, stamp: int) -> ReferenceSample:
    """The reference at `stamp` (ns); held at rest before its first and after its last sample."""
    motion = PlannedMotion(reference)
    return motion.sample(motion.row(stamp))


def sample_ahead(reference: Reference, stamp: int, lead: int) -> ReferenceSample:
    """The joints and accelerations `lead` ns after a stamp; see `PlannedMotion.row_ahead`."""
    motion = PlannedMotion(reference)
    return motion.sample(motion.row_ahead(stamp, lead))


@exact_kernel
def planned_row(stamps: Array, times: Array, table: Array, since: int) -> Array:
    """Row of the table (k, 22 + 3 n) at `since` ns; stamps (k,) ns, times (k,) s."""
    n, last = (table.shape[1] - JOINTS) // 3, stamps.shape[0] - 1
    if since < 0 or since > stamps[last]:
        row = table[0 if since < 0 else last].copy()
        row[NU:END_EFFECTOR] = 0.0
        row[JOINTS + n :] = 0.0
        return row
    i = 0
    while i < last and stamps[i + 1] <= since:
        i += 1
    if stamps[i] == since:
        return table[i].copy()
    start, end = table[i], table[i + 1]
    h = times[i + 1] - times[i]
    s = (since * 1e-9 - times[i]) / h
    row = (1.0 - s) * start + s * end  # accelerations and the end effector stay so
    angles, rates = slice(JOINTS, JOINTS + n), slice(JOINTS + n, JOINTS + 2 * n)
    _hermite(start[angles], end[angles], start[rates], end[rates], s, h, row[angles], row[rates])
    quaternion = row[QUATERNION:NU]
    _hermite_attitude(start, end, s, h, quaternion, row[NU + 3 : NU_DOT])
    begins = product(quat_to_matrix(start[QUATERNION:NU]), start[NU : NU + 3])
    ends = product(quat_to_matrix(end[QUATERNION:NU]), end[NU : NU + 3])
    velocity = np.empty(3)
    _hermite(start[:QUATERNION], end[:QUATERNION], begins, ends, s, h, row[:QUATERNION], velocity)
    row[NU : NU + 3] = transposed_product(quat_to_matrix(quaternion), velocity)
    return row


@exact_kernel
def _hermite(
    x0: Array, x1: Array, v0: Array, v1: Array, s: float, h: float, x: Array, v: Array
) -> None:
    """Cubic Hermite polynomial x and its time derivative v at the share s of an interval h."""
    for k in range(x.shape[0]):
        d = x1[k] - x0[k]
        curve = s * (1.0 - s) * h * ((1.0 - s) * v0[k] - s * v1[k])
        slope = (1.0 - s) * (1.0 - 3.0 * s) * v0[k] + s * (3.0 * s - 2.0) * v1[k]
        x[k] = x0[k] + s * s * (3.0 - 2.0 * s) * d + curve
        v[k] = 6.0 * s * (1.0 - s) * d / h + slope


@exact_kernel
def _hermite_attitude(
    start: Array, end: Array, s: float, h: float, quaternion: Array, omega: Array
) -> None:
    """Attitude and angular velocity (body frame) between the samples of two rows."""
    first = start[QUATERNION:NU]
    turn = quat_to_rotation_vector(quat_multiply(quat_conjugate(first), end[QUATERNION:NU]))
    rate = product(inverse_right_jacobian(turn), end[NU + 3 : NU_DOT])
    phi, phi_dot = np.empty(3), np.empty(3)
    _hermite(np.zeros(3), turn, start[NU + 3 : NU_DOT], rate, s, h, phi, phi_dot)
    turned = quat_multiply(first, rotation_vector_to_quat(phi))
    quaternion[:] = turned / np.sqrt(np.sum(turned**2))
    omega[:] = product(right_jacobian(phi), phi_dot)


@exact_kernel
def right_jacobian(phi: Array) -> Array:
    """J_r(phi) (3, 3): body angular velocity = J_r(phi) d(phi)/dt for R = exp([phi]x).

    I - (1 - cos a) / a^2 [phi]x + (a - sin a) / a^3 [phi]x^2 with a = |phi| (Chirikjian,
    Stochastic Models, Information Theory, and Lie Groups, vol. 2, eq. (10.86)).
    """
    angle = np.sqrt(np.sum(phi**2))
    cross = skew(phi)
    if angle < SMALL_ANGLE:
        return np.eye(3) - 0.5 * cross + squared(cross) / 6.0
    first = (1.0 - np.cos(angle)) / angle**2
    second = (angle - np.sin(angle)) / angle**3
    return np.eye(3) - first * cross + second * squared(cross)


@exact_kernel
def inverse_right_jacobian(phi: Array) -> Array:
    """J_r(phi)^-1 (3, 3) = I + [phi]x / 2 + (1 - a / 2 cot(a / 2)) / a^2 [phi]x^2 (ib.)."""
    angle = np.sqrt(np.sum(phi**2))
    cross = skew(phi)
    second = 1.0 / 12.0
    if angle >= SMALL_ANGLE:
        second = (1.0 - 0.5 * angle / np.tan(0.5 * angle)) / angle**2
    return np.eye(3) + 0.5 * cross + second * squared(cross)
