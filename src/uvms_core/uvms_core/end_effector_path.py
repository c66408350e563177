"""The end effector's path as a function of time, from the points of a goal."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from uvms_core import path_nodes
from uvms_core.errors import SignalError
from uvms_core.path_nodes import Ends
from uvms_core.pointing import Directions, normalized
from uvms_core.rotation_vectors import angular_motion, vector_motion
from uvms_core.signals import Array, PathGoal

SAME_ORIENTATION_RAD = 1e-12
"""Quaternions closer than this differ by rounding alone: between them nothing turns."""


class PathSample(NamedTuple):
    """Target of the end effector at one instant."""

    position: Array  # (3,) m, map_ned
    velocity: Array  # (3,) m/s
    quaternion: Array | None  # (4,) tool to map_ned, None where the goal has no orientations
    angular_velocity: Array | None  # (3,) rad/s, map_ned axes


class PathSamples(NamedTuple):
    """Targets of the end effector at k instants; the last three are None without orientations."""

    position: Array  # (k, 3) m, map_ned
    velocity: Array  # (k, 3) m/s
    acceleration: Array  # (k, 3) m/s^2
    quaternion: Array | None  # (k, 4) tool to map_ned
    angular_velocity: Array | None  # (k, 3) rad/s, map_ned axes
    angular_acceleration: Array | None  # (k, 3) rad/s^2, map_ned axes

    def first(self) -> PathSample:
        """The first of them."""
        turning = None if self.angular_velocity is None else self.angular_velocity[0]
        quaternion = None if self.quaternion is None else self.quaternion[0]
        return PathSample(self.position[0], self.velocity[0], quaternion, turning)


class EndEffectorPath:
    """C2 path through the points of a goal, at rest at both ends.

    Quintic segments whose slopes and second derivatives follow from five neighbouring points each,
    limited where they would overshoot, axis by axis: where the data rise or fall the path does so,
    too, and beside a turning point of the data it leaves the range of two points by half of the
    smaller neighbouring step at most, however uneven the times are (`path_nodes`). A circle by its
    points stays a circle: with 24 points a turn its acceleration is right within 1 %.

    Equal consecutive points are a pause, with rest at both of its ends. Velocity and acceleration
    are zero at the first and the last point; before and after it stays there.

    Orientations are treated alike, in the rotation vectors from each point to its neighbours, whose
    axes are those of map_ned: angular velocity and acceleration are continuous, and the tool turns
    the shorter way from point to point.

    Raises SignalError unless the times, two or more, increase from zero.
    """

    def __init__(self, goal: PathGoal):
        times = np.array(goal.times, dtype=float)
        if len(times) < 2 or times[0] != 0.0 or not np.all(np.diff(times) > 0.0):
            raise SignalError(f"path: its times {times} must increase from 0")
        self._times = times
        self._position = _position_curve(times, np.array(goal.positions, dtype=float))
        self._turn = _Turn(times, goal.orientations) if len(goal.orientations) else None
        self.tool_axis: Array | None = np.array(goal.tool_axis) if len(goal.tool_axis) else None
        """(3,) unit vector in the tool's axes that is to point along `directions`; None: none."""
        self._pointing = None
        if self.tool_axis is not None:
            self._pointing = _position_curve(times, np.array(goal.axis_directions, dtype=float))

    @property
    def duration(self) -> float:
        """Seconds from the first point to the last."""
        return float(self._times[-1])

    @property
    def oriented(self) -> bool:
        """Whether the path prescribes the orientation, too."""
        return self._turn is not None

    def samples(self, times: Array) -> PathSamples:
        """Position, velocity, acceleration and, where it is oriented, the same of the orientation,
        at `times` (k,) s.
        """
        inside = np.clip(times, 0.0, self.duration)
        linear = self._position.motion(inside)
        if self._turn is None:
            return PathSamples(*linear, None, None, None)
        return PathSamples(*linear, *self._turn.motion(inside))

    def directions(self, times: Array) -> Directions:
        """Where `tool_axis` is to point at `times` (k,) s; between the points as smooth as they.

        Directions that follow each other are less than a right angle apart.
        """
        if self._pointing is None:
            raise SignalError("the path has no tool_axis, and so no directions for it")
        return normalized(*self._pointing.motion(np.clip(times, 0.0, self.duration)))

    def sample(self, time: float) -> PathSample:
        """Position (3,), velocity (3,), quaternion (4,) and angular velocity (3,) at `time` s."""
        return self.samples(np.array([time])).first()

    def positions(self, times: Array) -> Array:
        """Positions (k, 3) at `times` (k,) s."""
        return self._position.values(np.clip(times, 0.0, self.duration))


class _Curve:
    """Quintic segments, each from its own origin; after the last there is rest."""

    def __init__(self, times: Array, origins: Array, steps: Array, ends: Ends):
        self._times = times
        h = np.diff(times)[:, None]
        m0, a0, m1, a1 = ends
        gap = steps - h * m0 - h**2 * a0 / 2
        slope, bend = h * (m1 - m0 - h * a0), h**2 * (a1 - a0)
        powers = (
            (10 * gap - 4 * slope + bend / 2) / h**3,
            (-15 * gap + 7 * slope - bend) / h**4,
            (6 * gap - 3 * slope + bend / 2) / h**5,
        )
        self._powers = np.zeros((6, *origins.shape))
        self._powers[0] = origins
        self._powers[1:, :-1] = (m0, a0 / 2, *powers)

    def index(self, times: Array) -> NDArray[np.int_]:
        """Segment (k,) of each time (k,), which are within the curve."""
        return np.searchsorted(self._times, times, side="right") - 1

    def values(self, times: Array) -> Array:
        """Values (k, d) at `times` (k,) s."""
        return self._at(times)[0]

    def motion(self, times: Array) -> tuple[Array, Array, Array]:
        """Values, first and second derivatives (k, d) at `times` (k,) s."""
        value, c, t = self._at(times)
        rate = c[1] + t * (2 * c[2] + t * (3 * c[3] + t * (4 * c[4] + 5 * t * c[5])))
        second = 2 * c[2] + t * (6 * c[3] + t * (12 * c[4] + 20 * t * c[5]))
        return value, rate, second

    def _at(self, times: Array) -> tuple[Array, Array, Array]:
        index = self.index(times)
        c = self._powers[:, index]
        t = (times - self._times[index])[:, None]
        return c[0] + t * (c[1] + t * (c[2] + t * (c[3] + t * (c[4] + t * c[5])))), c, t


def _position_curve(times: Array, points: Array) -> _Curve:
    """Through `points` (n, 3) at `times` (n,)."""
    steps = np.diff(points, axis=0)
    slope, second = np.zeros_like(points), np.zeros_like(points)
    lengths: Array = np.linalg.norm(steps, axis=1)
    for part in path_nodes.moving_stretches(lengths == 0.0):
        around = np.pad(points[part], ((path_nodes.REACH,) * 2, (0, 0)), mode="edge")
        values = path_nodes.windows(around) - points[part][:, None]
        stencil = path_nodes.windows(path_nodes.with_rest(times[part]))
        slope[part], second[part] = path_nodes.kept_in_shape(
            times[part],
            steps[part.start : part.stop - 1],
            path_nodes.quartic_derivatives(stencil, values),
        )
    return _Curve(times, points, steps, (slope[:-1], second[:-1], slope[1:], second[1:]))


class _Turn:
    """Orientations: quintic segments of the rotation vector from each point to the next.

    R(t) = exp(phi(t)) R_k, phi in map_ned axes. At its beginning the derivatives of phi are the
    angular velocity and acceleration; at its end they follow from those of the next point, so that
    both are continuous there.
    """

    def __init__(self, times: Array, quaternions: Array):
        self._rotations = Rotation.from_quat(_same_hemisphere(quaternions))
        self._arcs = (self._rotations[1:] * self._rotations[:-1].inv()).as_rotvec()
        omega, alpha = np.zeros((len(times), 3)), np.zeros((len(times), 3))
        lengths: Array = np.linalg.norm(self._arcs, axis=1)
        for part in path_nodes.moving_stretches(lengths <= SAME_ORIENTATION_RAD):
            omega[part], alpha[part] = self._stretch(times[part], part)
        ends = _ends_of_turns(self._arcs, omega, alpha)
        self._phi = _Curve(times, np.zeros((len(times), 3)), self._arcs, ends)

    def _stretch(self, times: Array, part: slice) -> tuple[Array, Array]:
        """Angular velocities and accelerations (n, 3) of the points between two rests."""
        quaternions, arcs = self._rotations[part].as_quat(), self._arcs[part.start : part.stop - 1]
        around = np.pad(quaternions, ((path_nodes.REACH,) * 2, (0, 0)), mode="edge")
        neighbours = path_nodes.windows(around)
        centres = Rotation.from_quat(np.repeat(quaternions, neighbours.shape[1], axis=0)).inv()
        values = (Rotation.from_quat(neighbours.reshape(-1, 4)) * centres).as_rotvec()
        derivatives = path_nodes.quartic_derivatives(
            path_nodes.windows(path_nodes.with_rest(times)), values.reshape(len(times), -1, 3)
        )
        return path_nodes.kept_in_shape(
            times, arcs, derivatives, lambda omega, alpha: _ends_of_turns(arcs, omega, alpha)
        )

    def motion(self, times: Array) -> tuple[Array, Array, Array]:
        """Quaternions (k, 4), angular velocities and accelerations (k, 3) in map_ned axes."""
        phi, rate, second = self._phi.motion(times)
        turned = Rotation.from_rotvec(phi) * self._rotations[self._phi.index(times)]
        return turned.as_quat(), *angular_motion(phi, rate, second)


def _ends_of_turns(arcs: Array, omega: Array, alpha: Array) -> Ends:
    """Derivatives of the rotation vector at both ends of each arc (k, 3)."""
    return omega[:-1], alpha[:-1], *vector_motion(arcs, omega[1:], alpha[1:])


def _same_hemisphere(quaternions: Array) -> Array:
    """The same orientations (n, 4), each with the sign that is nearer to the one before."""
    cosines = np.sum(quaternions[1:] * quaternions[:-1], axis=1)
    signs = np.cumprod(np.concatenate([[1.0], np.where(cosines < 0.0, -1.0, 1.0)]))
    return np.asarray(quaternions, dtype=float) * signs[:, None]
