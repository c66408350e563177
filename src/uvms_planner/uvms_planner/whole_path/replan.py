"""A whole path planned anew while it is followed: a few Newton steps with every call."""

from collections.abc import Callable, Generator, Sequence

from scipy.interpolate import make_interp_spline

from uvms_core.signals import Array
from uvms_planner.whole_path.discrete import Discrete, discretise
from uvms_planner.whole_path.newton import Schedule, newton_steps
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.pieces import coarse_breaks, fine_breaks
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.solve import (
    FULL,
    ROUGH,
    posture_held,
    repair_steps,
    repairs_of,
    size_of,
)
from uvms_planner.whole_path.spline import DEGREE, greville

SAMPLES = 800
"""Samples that a call of `advance` linearises, about, however long the path."""

Motion = Callable[[Array], Array]
"""Yaw and joints with two derivatives (k, 3, d) at times (k,) s."""


class Replanning:
    """Plans a path anew from a plan that was the best one before something changed.

    The search for the basin is left out: what changes while a path is followed moves the optimum,
    and rarely to another basin. No clock decides how far a call gets, so that the same calls give
    the same plan at the same step.

    Args:
        problem: from where things are on.
        known: the motion that is planned so far, times as in `problem`.
    """

    def __init__(self, problem: PathProblem, known: Motion) -> None:
        self.plan: PathPlan | None = None
        """The best plan so far: on coarse pieces, then on fine ones."""
        self.over = False
        """Whether nothing better will come."""
        self._problem = problem
        self._steps = self._planned(known)

    def advance(self) -> None:
        """Go on with the search by some Newton steps."""
        left = SAMPLES
        while left > 0 and not self.over:
            spent = next(self._steps, None)
            self.over = spent is None
            left -= spent or 0

    def _planned(self, known: Motion) -> Generator[int, None, None]:
        """The search, step by step; it yields the samples that a step has taken."""
        breaks = coarse_breaks(self._problem)
        coarse = discretise(self._problem, breaks)
        size = size_of(coarse, posture_held(coarse))
        yield from self._solved(coarse, fitted(coarse, known), ROUGH, size)
        if self.plan is not None:
            fine = discretise(self._problem, fine_breaks(breaks))
            begin = fine.taken_from(coarse.knots, self.plan.coefficients)
            yield from self._solved(fine, begin, FULL, size)

    def _solved(
        self, discrete: Discrete, start: Array, schedule: Schedule, size: float
    ) -> Generator[int, None, None]:
        """The best plan on one set of pieces becomes `plan`."""
        full = schedule.scaled(size)
        search = _optimum(discrete, start, full, repairs_of(full, size))
        while True:
            try:
                next(search)
            except StopIteration as end:
                self.plan = end.value
                return
            yield len(discrete.times)


def _optimum(
    discrete: Discrete, start: Array, schedule: Schedule, repairs: Sequence[Schedule]
) -> Generator[None, None, PathPlan]:
    solution = yield from newton_steps(discrete, start, schedule)
    return (yield from repair_steps(discrete, solution, repairs))


def fitted(discrete: Discrete, known: Motion) -> Array:
    """Coefficients (K, d) of the spline on these knots through a motion."""
    sites = greville(discrete.knots)
    values = known(sites)[:, 0]
    return discrete.complete(make_interp_spline(sites, values, k=DEGREE, t=discrete.knots).c)
