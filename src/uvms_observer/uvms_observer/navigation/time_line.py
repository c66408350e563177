"""The last steps of the filter, to which it can go back."""

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from uvms_observer.navigation.estimator import Estimator
from uvms_observer.navigation.samples import Reading, in_order


class Step(NamedTuple):
    """What one step of the filter started from, what it used, and where it ended."""

    before: Estimator
    readings: list[Reading]
    end: int  # ns

    @property
    def begin(self) -> int:
        """Time of the estimate that it started from, ns; -1 before the first."""
        return -1 if self.before.time is None else self.before.time


def replayed(
    estimator: Estimator, steps: Iterable[tuple[list[Reading], int]]
) -> tuple[list[Step], Estimator]:
    """Steps of readings and ends (ns) from an estimator on, and the estimator after them."""
    done = []
    for readings, end in steps:
        done.append(Step(estimator.copied(), readings, end))
        estimator.take(readings)
        estimator.advance(end)
    return done, estimator


def with_late(steps: Sequence[Step], late: Sequence[Reading]) -> list[tuple[list[Reading], int]]:
    """Readings and ends of steps, with readings that came late put into the step they belong to."""
    found, left = [], list(late)
    for step in steps:
        own = [reading for reading in left if reading.stamp <= step.end]
        left = [reading for reading in left if reading.stamp > step.end]
        found.append((in_order([*step.readings, *own]) if own else step.readings, step.end))
    return found
