"""The navigation filter over a feed of samples, tick by tick as in the loop."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from uvms_bringup.navigate.feed import Feed, Sample
from uvms_core import topics
from uvms_core.part import InProcess, Output
from uvms_core.plausibility import Plausibility
from uvms_core.signals import Odometry, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_observer import NavigationConfig
from uvms_observer.navigation.begin.resume import OLDEST_S
from uvms_observer.parts import NavigationPart

HOLE = to_nanoseconds(OLDEST_S)
"""A hole in a log that is longer than this is not filled, ns: the filter starts anew after it."""


class Estimation:
    """A filter at work on a log; `outputs` runs it once.

    Args:
        vehicle: of the log.
        config: of the filter.
        period: between two estimates, ns.
        start: where it begins; None: as configured.
    """

    def __init__(
        self, vehicle: Vehicle, config: NavigationConfig, period: int, start: Odometry | None
    ) -> None:
        self.part = NavigationPart(vehicle, config, period)
        if start is not None:
            self.part.remember(start)
        self._process = InProcess({topics.NAVIGATION: self.part}, Plausibility(vehicle))
        self._period = period
        self.ticks = 0
        self.restarts = 0

    def outputs(self, feed: Feed) -> Iterator[Output]:
        """Estimates and diagnostics, in order; they begin with the first inertial sample."""
        tick, waiting = None, list[Sample]()
        for sample in feed.samples():
            if tick is None:  # what comes before attitude and rates is of no use
                waiting = [*waiting[-1000:], sample]
                if sample.topic.name != self.part.trigger.name:
                    continue
                tick = self._tick_at(sample.arrival)
                self._admit(waiting)
                continue
            while sample.arrival > tick:
                yield from self._tick(tick)
                tick = self._next(tick, sample.arrival)
            self._admit([sample])
        if tick is not None:
            yield from self._tick(tick)

    def _tick_at(self, arrival: int) -> int:
        """The tick at or after an arrival."""
        return -(-arrival // self._period) * self._period

    def _next(self, tick: int, arrival: int) -> int:
        """The tick after this one, beyond a hole if there is one."""
        if arrival - tick <= HOLE:
            return tick + self._period
        self.restarts += 1
        self.part.restart(f"the log has no samples for {to_seconds(arrival - tick):.0f} s")
        return self._tick_at(arrival)

    def _admit(self, samples: list[Sample]) -> None:
        with np.errstate(all="ignore"):  # what overflows is refused
            self._process.admit_all([(each.topic, each.signal) for each in samples])

    def _tick(self, stamp: int) -> Iterator[Output]:
        self.ticks += 1
        with np.errstate(all="ignore"):
            for _, outputs in self._process.tick(stamp):
                yield from outputs

    def status(self) -> dict[str, Any]:
        """What the filter has counted, and what was refused before it."""
        return {**self.part.status(), "implausible": self._process.refused}
