"""A path that starts at an offset from the tool, joined smoothly."""

import numpy as np
from numpy.linalg import norm
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath, PathSample, PathSamples
from uvms_core.pointing import Directions
from uvms_core.signals import Array

NEGLIGIBLE = 1e-7  # m or rad between the tool and the beginning of a path


class JoinedPath:
    """A path that begins where the tool is and joins `path` smoothly within `approach` s.

    The gap at the start fades as 1 - s, s = 10 u^3 - 15 u^4 + 6 u^5, u = t / approach; the timing
    stays the path's own.
    """

    def __init__(self, path: EndEffectorPath, position: Array, quaternion: Array, approach: float):
        self._path = path
        self._approach = min(approach, path.duration)
        start = path.sample(0.0)
        self._gap, self._turn = position - start.position, np.zeros(3)
        if start.quaternion is not None:
            first = Rotation.from_quat(start.quaternion)
            self._turn = (Rotation.from_quat(quaternion) * first.inv()).as_rotvec()
        self._swing = np.zeros(3)
        if path.tool_axis is not None:
            axis = Rotation.from_quat(quaternion).apply(path.tool_axis)
            self._swing = _turn_between(path.directions(np.zeros(1)).direction[0], axis)
        gaps = norm(self._gap), norm(self._turn), norm(self._swing)
        self._begins_on_path = bool(max(gaps) < NEGLIGIBLE)

    @property
    def duration(self) -> float:
        """Seconds from the first point to the last."""
        return self._path.duration

    @property
    def oriented(self) -> bool:
        """Whether the path prescribes the orientation, too."""
        return self._path.oriented

    @property
    def tool_axis(self) -> Array | None:
        """As of EndEffectorPath."""
        return self._path.tool_axis

    @property
    def goal(self) -> EndEffectorPath:
        """The path that is joined."""
        return self._path

    def joined(self, time: float) -> bool:
        """Whether the gap has faded at `time` s, or there was none."""
        return self._begins_on_path or time >= self._approach

    def sample(self, time: float) -> PathSample:
        """As of EndEffectorPath."""
        return self.samples(np.array([time])).first()

    def samples(self, times: Array) -> PathSamples:
        """As of EndEffectorPath: position, velocity, acceleration, the same of the orientation."""
        on_path = self._path.samples(times)
        if self._begins_on_path or np.min(times) >= self._approach:
            return on_path
        share, rate, bend = (part[:, None] for part in self._fading(times))
        position = on_path.position + share * self._gap
        velocity = on_path.velocity + rate * self._gap
        acceleration = on_path.acceleration + bend * self._gap
        if not self.oriented:
            return PathSamples(position, velocity, acceleration, None, None, None)
        off = Rotation.from_rotvec(share * self._turn)
        turning, bending = rate * self._turn, bend * self._turn
        omega = off.apply(on_path.angular_velocity)
        alpha = off.apply(on_path.angular_acceleration) + np.cross(turning, omega) + bending
        quaternion = (off * Rotation.from_quat(on_path.quaternion)).as_quat()
        return PathSamples(position, velocity, acceleration, quaternion, turning + omega, alpha)

    def directions(self, times: Array) -> Directions:
        """As of EndEffectorPath: where `tool_axis` is to point."""
        on_path = self._path.directions(times)
        share, rate, bend = (part[:, None] for part in self._fading(times))
        off, turning, bending = (
            Rotation.from_rotvec(share * self._swing),
            rate * self._swing,
            bend * self._swing,
        )
        direction, own = off.apply(on_path.direction), off.apply(on_path.rate)
        swept = np.cross(turning, direction)
        acceleration = np.cross(bending, direction) + np.cross(turning, swept + 2 * own)
        return Directions(direction, swept + own, acceleration + off.apply(on_path.acceleration))

    def positions(self, times: Array) -> Array:
        """Positions (k, 3) at `times` (k,) s."""
        return self.samples(times).position

    def _fading(self, times: Array) -> tuple[Array, Array, Array]:
        """Share (k,) of the gap that is left, and its first and second derivative, 1/s and 1/s^2.

        Before the start and after the approach both derivatives are zero, u being 0 or 1.
        """
        u = np.clip(np.asarray(times) / self._approach, 0.0, 1.0)
        left = 1 - u**3 * (10 - 15 * u + 6 * u**2)
        rate = -30 * (u * (1 - u)) ** 2 / self._approach
        return left, rate, -60 * u * (1 - u) * (1 - 2 * u) / self._approach**2


def _turn_between(first: Array, second: Array) -> Array:
    """Rotation vector (3,) of the shortest turn from a unit vector to another, less than half."""
    normal = np.cross(first, second)
    sine = float(norm(normal))
    if sine == 0.0:
        return np.zeros(3)
    return np.arctan2(sine, first @ second) / sine * normal
