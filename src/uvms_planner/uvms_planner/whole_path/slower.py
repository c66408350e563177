"""Where a path is too fast: how much slower it can be followed."""

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
    """A path followed in `factor` times its time; `plan` may break a limit at any factor."""

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
) -> SlowerPlan:
    """The plan with the smallest factor, within 3 %, at which the path can be followed.

    Where it cannot be followed at any speed, the plan at the greatest factor tells why.
    """
    fast, slow = 1.0, SLOWEST
    progress(0.0, f"{slow:g} times slower")
    slowest = _on_coarse(slowed(problem, slow))
    if not slowest.report.feasible:
        return SlowerPlan(slow, slowest)
    while slow > FINE_ENOUGH * fast:
        middle = float(np.sqrt(fast * slow))
        progress(0.1, f"{middle:.2f} times slower")
        if _on_coarse(slowed(problem, middle)).report.feasible:
            slow = middle
        else:
            fast = middle
    return _confirmed(problem, slow, seed, progress)


def _on_coarse(problem: PathProblem) -> PathPlan:
    """A plan on the coarse pieces, within the limits where that is possible."""
    coarse = discretise(problem, coarse_breaks(problem))
    held = posture_held(coarse)
    found = solve_on_knots(coarse, held, THOROUGH.scaled(size_of(coarse, held)))
    return PathPlan(problem, coarse.knots, found.coefficients, found.iterations)


def _confirmed(problem: PathProblem, factor: float, seed: int, progress: Progress) -> SlowerPlan:
    """The full plan at `factor`, or at the next greater one at which it keeps the limits."""
    for _ in range(CONFIRMATIONS):
        slower = SlowerPlan(
            factor, solve(slowed(problem, factor), seed, _of_factor(progress, factor))
        )
        if slower.plan.report.feasible:
            break
        factor *= LITTLE
    return slower


def _of_factor(progress: Progress, factor: float) -> Progress:
    """What is reported while the full plan at a factor is made."""
    return lambda share, _: progress(0.2 + 0.8 * share, f"{factor:.2f} times slower")
