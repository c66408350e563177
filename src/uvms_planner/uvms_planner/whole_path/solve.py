"""The best plan over a whole path that can be found: a search for the basin, then the optimum."""

from collections.abc import Callable, Generator, Sequence

import numpy as np

from uvms_core.signals import Array
from uvms_planner.whole_path.discrete import Discrete, discretise
from uvms_planner.whole_path.newton import (
    Schedule,
    Solution,
    finished,
    newton_steps,
    solve_on_knots,
)
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.pieces import coarse_breaks, fine_breaks
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.search import search

ROUGH = Schedule(barriers=(1e-1, 1e-2, 1e-3, 1e-4))
FULL = Schedule(barriers=(1e-3, 1e-4, 1e-5))
THOROUGH = Schedule(barriers=(10.0, 1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5), steps=20, final_steps=40)
"""From far inside the limits, each barrier solved: where `FULL` gets stuck at a broken limit."""
WITHIN = Schedule(barriers=(1e-1, 1e-2, 1e-3, 1e-4, 1e-5))
"""From a plan that keeps the limits, or nearly."""
REPAIR = Schedule(barriers=(1e-4, 1e-5))
REPAIRS = 3  # times at most that limits are tightened where a plan exceeds them between samples
SPARE = 2e-3  # share of a limit by which it is tightened more than it was exceeded
HIGHER = 10.0  # price of a limit from one repair to the next
HOPELESS = 0.1  # excess that no tightening mends
FAR = 0.5  # excess on the coarse pieces that finer ones do not mend

Progress = Callable[[float, str], None]


def solve(
    problem: PathProblem, seed: int = 0, progress: Progress = lambda share, text: None
) -> PathPlan:
    """The plan of least self-disturbance within the limits; the same for the same seed.

    Where the limits cannot be kept, the plan breaks them least; its report says which and where.
    """
    breaks = coarse_breaks(problem)
    coarse, fine = discretise(problem, breaks), discretise(problem, fine_breaks(breaks))
    progress(0.0, "searching")
    held = posture_held(coarse)
    size = size_of(coarse, held)
    rough = _rough(coarse, held, seed, size, lambda share: progress(share / 2, "searching"))
    tick = ticker(lambda share: progress(0.5 + share / 2, "whole path"), FULL)
    begin = fine.taken_from(coarse.knots, rough[0].coefficients)
    plan = _on_fine(fine, begin, FULL.scaled(size), size, tick)
    if not plan.report.feasible:
        starts = [held, *(each.coefficients for each in rough)]
        plan = _within_limits(plan, coarse, fine, starts, size, progress)
    progress(1.0, "whole path")
    return plan


def _within_limits(
    plan: PathPlan,
    coarse: Discrete,
    fine: Discrete,
    starts: Sequence[Array],
    size: float,
    progress: Progress,
) -> PathPlan:
    """A plan that keeps the limits, where `plan` got stuck; the nearest where none is found.

    `starts` are coefficients on the coarse pieces, the posture held first.

    From the posture held where that keeps them itself, so that no path is refused that the vehicle
    alone can follow. Else thoroughly on the coarse pieces, where that takes little; what those can
    do, the fine can.
    """
    still = fine.taken_from(coarse.knots, starts[0])
    alone = PathPlan(fine.problem, fine.knots, still, plan.iterations)
    if alone.report.feasible:
        other = _on_fine(fine, still, FULL.scaled(size), size)
        return other if other.report.feasible else alone
    for number, start in enumerate(starts):
        progress(0.5 + number / 2 / len(starts), "within the limits")
        found = solve_on_knots(coarse, start, THOROUGH.scaled(size))
        rough = PathPlan(coarse.problem, coarse.knots, found.coefficients, found.iterations)
        if rough.report.worst.share > 1 + FAR:
            continue
        begin = fine.taken_from(coarse.knots, found.coefficients)
        other = _on_fine(fine, begin, WITHIN.scaled(size), size)
        if other.report.feasible:
            return other
        same = PathPlan(fine.problem, fine.knots, begin, found.iterations)
        plan = min(plan, other, same, key=_worst_share)
        if plan.report.feasible:
            return plan
    if plan.report.worst.share > 1 + FAR:
        return plan
    other = _on_fine(fine, plan.coefficients, THOROUGH.scaled(size), size)
    return min(plan, other, key=_worst_share)


def _worst_share(plan: PathPlan) -> float:
    return plan.report.worst.share


def posture_held(discrete: Discrete) -> Array:
    """Coefficients (K, d) of the posture of the start."""
    return np.tile(discrete.problem.start.value, (len(discrete.grid.numbers), 1))


def size_of(discrete: Discrete, held: Array) -> float:
    """Mean square of the disturbance with the posture held, N^2 and N^2 m^2; at least 1.

    Prices and barriers go by it: what breaks no limit with an arm of 1 kg may not with one of 50.
    """
    return max(1.0, discrete.disturbance(discrete.complete(held)) / discrete.problem.duration)


def _rough(
    coarse: Discrete, held: Array, seed: int, size: float, progress: Callable[[float], None]
) -> list[Solution]:
    """The optima near the posture held and near the fittest of the search, the better one first.

    Prices count for disturbances of the mean square `size`, N^2 and N^2 m^2.
    """
    rough = ROUGH.scaled(size)
    first = solve_on_knots(coarse, held, rough, ticker(lambda s: progress(s / 3), rough))
    fittest = search(coarse, seed)
    progress(2 / 3)
    second = solve_on_knots(coarse, fittest, rough, ticker(lambda s: progress((2 + s) / 3), rough))
    return sorted([first, second], key=lambda solution: solution.cost)


def _on_fine(
    fine: Discrete,
    begin: Array,
    schedule: Schedule,
    size: float,
    tick: Callable[[], None] = lambda: None,
) -> PathPlan:
    """The plan near `begin` (K, d), with the limits kept between the samples as well."""
    solution = solve_on_knots(fine, begin, schedule, tick)
    return finished(repair_steps(fine, solution, repairs_of(schedule, size)))


def repairs_of(full: Schedule, size: float) -> list[Schedule]:
    """What mends limits that a plan exceeds between its samples, dearer each time."""
    return [REPAIR.scaled(size).at_price(HIGHER**k * full.price) for k in range(1, REPAIRS + 1)]


def repair_steps(
    discrete: Discrete, solution: Solution, repairs: Sequence[Schedule]
) -> Generator[None, None, PathPlan]:
    """The plan of a solution, with the limits kept between the samples as well; step by step."""
    count = solution.iterations
    for repair in repairs:
        plan = PathPlan(discrete.problem, discrete.knots, solution.coefficients, count)
        excess = plan.report.excess
        if plan.report.feasible or excess.max() > HOPELESS:
            return plan
        discrete = discrete.tightened(excess + SPARE)
        solution = yield from newton_steps(discrete, solution.coefficients, repair)
        count += solution.iterations
    return PathPlan(discrete.problem, discrete.knots, solution.coefficients, count)


def ticker(progress: Callable[[float], None], schedule: Schedule) -> Callable[[], None]:
    """Reports after each step how much of the schedule is done at least."""
    done, most = [0], schedule.most_steps

    def tick() -> None:
        done[0] += 1
        progress(done[0] / most)

    return tick
