"""Where to leave a motion so that coming to rest keeps limits and clearances.

A stop brakes straight on, each variable for itself, and a path may just go round something. The
motion itself keeps to everything, so that it may be followed a little farther first.
"""

from collections.abc import Callable

import numpy as np

from uvms_core.signals import Array, to_nanoseconds
from uvms_dynamics.geometry import clearances_along
from uvms_planner.segment import Knot, Samples
from uvms_planner.solver import StepSolver
from uvms_planner.stop import Stop

FARTHEST_S = 20.0  # that a motion is followed at most before it is left
FORGIVEN = 1e-3  # share of a limit; of bounds and clearances m and rad

Next = Callable[[Knot], tuple[Knot, Samples]]
"""The next knot of a motion, and the samples on the way to it."""


class LedStop:
    """Follows segments that are planned already, then stops; used as a `Stop`."""

    def __init__(self, lead: list[tuple[Knot, Samples]], start: int, step: float, stop: Stop):
        """`lead` begins at the stamp `start`."""
        self._lead, self._start, self._stop = lead, start, stop
        self._step = to_nanoseconds(step)

    @property
    def rest(self) -> int:
        """As of Stop."""
        return self._stop.rest

    def end(self, stamp: int) -> Knot:
        """As of Stop."""
        return self._stop.end(stamp)

    def plan(self, knot: Knot, times: Array) -> tuple[Knot, Samples]:
        """As of Stop; on the lead at the times that it was planned for."""
        number = (knot.stamp - self._start) // self._step
        if number < len(self._lead):
            return self._lead[number]
        return self._stop.plan(knot, times)


def safe_stop(
    stop: Stop, knot: Knot, follow: Next, until: int, solver: StepSolver, times: Array
) -> Stop | LedStop:
    """The earliest stop that keeps limits and clearances, from `knot` on.

    Where there is none within `FARTHEST_S`, or before the motion's end at the stamp `until`, the
    one that breaks them least.

    Args:
        stop: at once.
        follow: the motion that is left.
        times: (k,) s of the samples of a step.
    """
    step = solver.config.step_s
    start, lead = knot.stamp, list[tuple[Knot, Samples]]()
    best: Stop | LedStop = stop
    least = harm(stop, knot, solver, times)
    for _ in range(int(FARTHEST_S / step)):
        if least <= FORGIVEN or knot.stamp >= until:
            break
        knot, samples = follow(knot)
        lead.append((knot, samples))
        later = Stop(solver, knot, step)
        found = harm(later, knot, solver, times)
        if found < least:
            best, least = LedStop(list(lead), start, step, later), found
    return best


def harm(stop: Stop, knot: Knot, solver: StepSolver, times: Array) -> float:
    """By how much a stop exceeds what a plan may do: shares of limits, m, rad; below 0 it does not.

    What is exceeded at the knot already counts from there on.
    """
    if knot.stamp >= stop.rest:
        return -1.0
    parts = []
    while knot.stamp < stop.rest:
        knot, samples = stop.plan(knot, times)
        parts.append(samples)
    c, rate, acceleration = (
        np.vstack([getattr(part, name) for part in parts])
        for name in ("configuration", "rate", "acceleration")
    )
    limits, first = solver.motion_limits, c[0]
    beyond = [
        _share(rate, limits.rate),
        _share(acceleration, limits.acceleration),
        float(np.max(np.minimum(limits.lower, first) - c)),
        float(np.max(c - np.maximum(limits.upper, first))),
    ]
    if len(solver.around.margins):
        clear = clearances_along(solver.geometry, c)
        beyond.append(float(np.max(np.minimum(solver.around.margins, clear[0]) - clear)))
    return max(beyond)


def _share(values: Array, limits: Array) -> float:
    """By which share values (k, m) exceed the greater of their limits (m,) and their first."""
    sizes = np.abs(values)
    return float(np.max(sizes / np.maximum(limits, sizes[0]))) - 1.0
