"""The end effector's path as a function of time, from the points of a goal."""

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array, PathGoal


class PathSample(NamedTuple):
    """Target of the end effector at one instant."""

    position: Array  # (3,) m, map_ned
    velocity: Array  # (3,) m/s
    quaternion: Array | None  # (4,) tool to map_ned, None where the goal has no orientations
    angular_velocity: Array | None  # (3,) rad/s, map_ned axes


class EndEffectorPath:
    """Shape-preserving C1 path through the points of a goal, at rest at both ends.

    Positions: cubic Hermite segments with the slopes of Fritsch and Carlson (PCHIP), zero at the
    first and the last point. Orientations: great arcs (slerp) from point to point; the angle along
    the arcs is interpolated as the positions are, so that the turning rate is continuous.
    Before the first time and after the last the path stays where it begins and ends.
    """

    def __init__(self, goal: PathGoal):
        self._times = np.array(goal.times, dtype=float)
        self._position = _at_rest_at_both_ends(self._times, np.array(goal.positions, dtype=float))
        self._velocity = self._position.derivative()
        self._turn = _Turn(self._times, goal.orientations) if len(goal.orientations) else None

    @property
    def duration(self) -> float:
        """Seconds from the first point to the last."""
        return float(self._times[-1])

    @property
    def oriented(self) -> bool:
        """Whether the path prescribes the orientation, too."""
        return self._turn is not None

    def sample(self, time: float) -> PathSample:
        """Position (3,), velocity (3,), quaternion (4,) and angular velocity (3,) at `time` s."""
        inside = min(max(time, 0.0), self.duration)
        position, velocity = self._position(inside), self._velocity(inside)
        if self._turn is None:
            return PathSample(position, velocity, None, None)
        return PathSample(position, velocity, *self._turn.sample(inside))

    def positions(self, times: Array) -> Array:
        """Positions (k, 3) at `times` (k,) s."""
        return self._position(np.clip(times, 0.0, self.duration))


class _Turn:
    """Orientation along great arcs, the angle interpolated with a continuous rate."""

    def __init__(self, times: Array, quaternions: Array):
        self._rotations = Rotation.from_quat(quaternions)
        self._arcs = (self._rotations[1:] * self._rotations[:-1].inv()).as_rotvec()
        lengths = np.linalg.norm(self._arcs, axis=1)
        self._angles = np.concatenate([[0.0], np.cumsum(lengths)])
        self._angle = _at_rest_at_both_ends(times, self._angles)
        self._rate = self._angle.derivative()
        self._times = times

    def sample(self, time: float) -> tuple[Array, Array]:
        """Quaternion (4,) and angular velocity (3,) in world axes."""
        index = int(np.searchsorted(self._times, time, side="right")) - 1
        index = min(max(index, 0), len(self._arcs) - 1)
        length = self._angles[index + 1] - self._angles[index]
        if length == 0.0:
            return self._rotations[index].as_quat(), np.zeros(3)
        share = (float(self._angle(time)) - self._angles[index]) / length
        turned = Rotation.from_rotvec(share * self._arcs[index]) * self._rotations[index]
        return turned.as_quat(), float(self._rate(time)) / length * self._arcs[index]


def _at_rest_at_both_ends(times: Array, values: Array) -> CubicHermiteSpline:
    slopes = PchipInterpolator(times, values)(times, 1)
    slopes[0] = 0.0
    slopes[-1] = 0.0
    return CubicHermiteSpline(times, values, slopes)
