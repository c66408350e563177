"""Simulated time against wall time."""

import time
from collections.abc import Callable

from uvms_core.signals import to_seconds


class Metronome:
    """Keeps simulation time to wall time times a rate; rate 0 does not wait."""

    def __init__(self, rate: float, clock: Callable[[], float] = time.monotonic) -> None:
        self._rate, self._clock = rate, clock
        self._origin: tuple[float, int] | None = None

    def ahead(self, stamp: int) -> float:
        """Wall seconds until a stamp is due; none for the first one."""
        if self._origin is None:
            self._origin = self._clock(), stamp
        if self._rate == 0.0:
            return 0.0
        began, first = self._origin
        return began + to_seconds(stamp - first) / self._rate - self._clock()
