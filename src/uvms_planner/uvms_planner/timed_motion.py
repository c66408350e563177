"""A motion of the whole configuration that is known from its beginning to its end."""

from abc import ABC, abstractmethod
from copy import copy
from typing import Self

import numpy as np

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.segment import Knot, Samples


class TimedMotion(ABC):
    """Gives the steps of a motion that begins at the stamp `start` and takes `duration` s."""

    def __init__(self, start: int, step: float) -> None:
        """`start` in ns, `step` of the planner in s."""
        self._start, self._step = start, step

    @property
    @abstractmethod
    def duration(self) -> float:
        """Seconds that the motion takes."""

    @abstractmethod
    def sample(self, times: Array) -> Samples:
        """Configuration, rate and acceleration (k, m) at `times` (k,) s after the start."""

    def starting(self, stamp: int) -> Self:
        """The same motion from another stamp on, ns."""
        other = copy(self)
        other._start = stamp
        return other

    @property
    def start(self) -> int:
        """Stamp at which the motion begins."""
        return self._start

    @property
    def end(self) -> int:
        """Stamp at which the motion ends."""
        return self._start + to_nanoseconds(self.duration)

    def elapsed(self, stamp: int) -> float:
        """Seconds of the motion that are done at `stamp`, within 0 and its duration."""
        return min(max(to_seconds(stamp - self._start), 0.0), self.duration)

    def plan(self, knot: Knot, times: Array) -> tuple[Knot, Samples]:
        """The next knot after `knot`, and the motion to it at `times` (k,) s."""
        begin = to_seconds(knot.stamp - self._start)
        last = self.sample(np.array([begin + self._step]))
        end = Knot(
            stamp=knot.stamp + to_nanoseconds(self._step),
            configuration=last.configuration[0],
            rate=last.rate[0],
            acceleration=last.acceleration[0],
            increment=last.configuration[0] - knot.configuration,
        )
        return end, self.sample(begin + times)
