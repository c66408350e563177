"""Where a path is too fast: how much slower it can be followed."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import solve_on_knots
from uvms_planner.whole_path.path_problem import PathProblem, Posture
from uvms_planner.whole_path.pieces import coarse_breaks
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.solve import THOROUGH, Progress, posture_held, size_of, solve

SLOWEST = 30.0  # factor beyond which the time is not what keeps a path from being followed
FINE_ENOUGH = 1.03  # ratio between a factor that is too fast and one that is not
LITTLE = 1.02  # by which a factor grows while the full plan does not confirm it
CONFIRMATIONS = 5


@dataclass(frozen=True)
class SlowerPlan:
    """A path followed in `factor` times its time."""

    factor: float
    plan: PathPlan


def slowed(problem: PathProblem, factor: float) -> PathProblem:
    """The same way in `factor` times the time, from the same posture at rest."""
    return replace(
        problem,
        tool=problem.tool.slower(factor),
        duration=problem.duration * factor,
        start=Posture.at_rest(problem.start.value),
    )


def slow_down(
    problem: PathProblem, seed: int = 0, progress: Progress = lambda share, text: None
) -> SlowerPlan | None:
    """The plan with the smallest factor, within 3 %, at which the path can be followed.

    None where it cannot be followed at any speed.
    """
    fast, slow = 1.0, SLOWEST
    progress(0.0, f"{slow:g} times slower")
    if not _possible(slowed(problem, slow)):
        return None
    while slow > FINE_ENOUGH * fast:
        middle = float(np.sqrt(fast * slow))
        progress(0.1, f"{middle:.2f} times slower")
        if _possible(slowed(problem, middle)):
            slow = middle
        else:
            fast = middle
    return _fastest(problem, slow, seed, progress)


def _possible(problem: PathProblem) -> bool:
    """Whether a plan on the coarse pieces keeps the limits."""
    coarse = discretise(problem, coarse_breaks(problem))
    held = posture_held(coarse)
    found = solve_on_knots(coarse, held, THOROUGH.scaled(size_of(coarse, held)))
    plan = PathPlan(problem, coarse.knots, found.coefficients, found.iterations)
    return plan.report.feasible


def _fastest(
    problem: PathProblem, slow: float, seed: int, progress: Callable[[float, str], None]
) -> SlowerPlan | None:
    """The full plan at the smallest factor up to `slow`, or at one slightly greater."""

    def planned(factor: float) -> SlowerPlan | None:
        share, text = 0.2, f"{factor:.2f} times slower"
        progress(share, text)
        plan = solve(slowed(problem, factor), seed, lambda s, _: progress(share + 0.8 * s, text))
        return SlowerPlan(factor, plan) if plan.report.feasible else None

    found = None
    for number in range(CONFIRMATIONS):
        found = planned(slow * LITTLE**number)
        if found is not None:
            break
    best = found
    while found is not None and found.factor > FINE_ENOUGH:
        best, found = found, planned(found.factor / FINE_ENOUGH)
    return found or best
