"""A path that starts at an offset from the tool, joined smoothly."""

import numpy as np
from numpy.linalg import norm
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath, PathSample
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
        self._begins_on_path = bool(max(norm(self._gap), norm(self._turn)) < NEGLIGIBLE)

    @property
    def duration(self) -> float:
        """Seconds from the first point to the last."""
        return self._path.duration

    @property
    def oriented(self) -> bool:
        """Whether the path prescribes the orientation, too."""
        return self._path.oriented

    @property
    def goal(self) -> EndEffectorPath:
        """The path that is joined."""
        return self._path

    def joined(self, time: float) -> bool:
        """Whether the gap has faded at `time` s, or there was none."""
        return self._begins_on_path or time >= self._approach

    def sample(self, time: float) -> PathSample:
        """As of EndEffectorPath."""
        sample = self._path.sample(time)
        if self.joined(time):
            return sample
        share, rate = self._fading(np.array([time]))
        position = sample.position + share[0] * self._gap
        velocity = sample.velocity + rate[0] * self._gap
        if sample.quaternion is None or sample.angular_velocity is None:
            return PathSample(position, velocity, None, None)
        off = Rotation.from_rotvec(share[0] * self._turn)
        turned = off * Rotation.from_quat(sample.quaternion)
        angular_velocity = rate[0] * self._turn + off.apply(sample.angular_velocity)
        return PathSample(position, velocity, turned.as_quat(), angular_velocity)

    def _fading(self, times: Array) -> tuple[Array, Array]:
        """Share (k,) of the gap that is left, and its rate in 1/s."""
        u = np.clip(times / self._approach, 0.0, 1.0)
        return 1 - u**3 * (10 - 15 * u + 6 * u**2), -30 * (u * (1 - u)) ** 2 / self._approach
