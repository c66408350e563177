"""What a fault explains leaves the external wrench at once, and not with its bandwidth.

Until a fault is named, the thrust that is missing is part of the external wrench. From then on the
allocator counts it, and what the filter still remembers would count it twice for the next second,
just when the thrusters that are left have nothing to spare. The filter is linear: what it has made
of the missing thrust since the onset is known, and is taken out.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_observer.health.monitor import Fault

WAITS_FOR = 5
"""Ticks within which the allocator counts what was named: it reads it a tick later, and tells it
one more tick later. Where it does not, a user has said otherwise, which comes before."""


class Handover:
    """Follows a fault from its verdict until the allocator counts it.

    Args:
        matrix: wrench of one newton of each thruster (6, m).
    """

    def __init__(self, matrix: Array) -> None:
        self._matrix = matrix
        self._open: Fault | None = None
        self._counted, self._ticks = 0.0, 0

    def remembered(self, fault: Fault, gain: Array, counted: Array) -> Array:
        """Share (6,) of the filtered wrench that a fault explains, to be added to it.

        Args:
            fault: just named; the newest of its thrusts is that of the interval that comes next.
            gain: (6,) of the filter in each interval.
            counted: (m,) shares with which the thrusters were counted.
        """
        self._open, self._ticks = fault, 0
        self._counted = float(counted[fault.thruster]) if counted.size else 1.0
        past = fault.thrusts[:-1]
        ages = np.arange(past.size)[::-1]
        memory = gain[:, None] * (1.0 - gain[:, None]) ** ages
        explained: Array = self._matrix[:, fault.thruster] * (memory @ past) * fault.share
        return explained

    def of_interval(self, thrust: Array, counted: Array) -> Array | None:
        """Wrench (6,) of an interval that is explained and not counted yet; None: nothing.

        Args:
            thrust: (m,) mean over the interval, as commanded and lagged, N.
            counted: (m,) shares with which the thrusters were counted in it.
        """
        fault = self._open
        if fault is None:
            return None
        share = float(counted[fault.thruster]) if counted.size else 1.0
        self._ticks += 1
        if share != self._counted or self._ticks > WAITS_FOR:
            self._open = None
            return None
        explained: Array = self._matrix[:, fault.thruster] * thrust[fault.thruster] * fault.share
        return explained
