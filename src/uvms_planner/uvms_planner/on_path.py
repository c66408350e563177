"""A motion along one path that begins at a stamp."""

from abc import ABC, abstractmethod
from dataclasses import dataclass

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.choice import Choice
from uvms_planner.joined_path import JoinedPath
from uvms_planner.problem import StepProblem
from uvms_planner.segment import Knot, Samples


@dataclass(frozen=True)
class FollowedStep:
    """One planned step along the path."""

    knot: Knot  # where it ends
    samples: Samples
    problem: StepProblem
    choice: Choice
    planned_error: float  # m, greatest distance of the samples from the goal's path


class OnPath(ABC):
    """What there is to know of a path that is being followed, whoever plans the motion."""

    def __init__(self, path: JoinedPath, start: int) -> None:
        """`start` in ns."""
        self.path = path
        self._start = start

    @property
    def start(self) -> int:
        """Stamp at which the path begins."""
        return self._start

    @property
    def end(self) -> int:
        """Stamp at which the path ends."""
        return self._start + to_nanoseconds(self.path.duration)

    def elapsed(self, stamp: int) -> float:
        """Seconds of the path that are done at `stamp`, within 0 and its duration."""
        return min(max(to_seconds(stamp - self._start), 0.0), self.path.duration)

    @abstractmethod
    def plan(self, knot: Knot, times: Array) -> FollowedStep:
        """The step after `knot`, sampled at `times` (k,) s; where `choice.valid` is False the
        nearest that can be reached.
        """
