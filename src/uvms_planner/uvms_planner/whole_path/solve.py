"""The best plan over a whole path that can be found: a search for the basin, then the optimum."""

from collections.abc import Callable

import numpy as np

from uvms_core.signals import Array
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import Schedule, solve_on_knots
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.plan import PathPlan

FIRST_S = 0.1  # the first piece: a posture that is left quickly needs fine pieces
GROWTH = 1.15  # from one piece to the next
PIECES = 240  # of a path of medium length
FINEST_S, COARSEST_S = 0.5, 3.0  # of the pieces after the beginning

Progress = Callable[[float, str], None]


def graded_breaks(duration: float) -> Array:
    """Ends of the pieces (b,): fine at the beginning, even later; as many as the path is long."""
    spacing = float(np.clip(duration / PIECES, FINEST_S, COARSEST_S))
    lengths = [min(FIRST_S, duration / 8)]
    while sum(lengths) < duration:
        lengths.append(min(lengths[-1] * GROWTH, spacing))
    breaks = np.concatenate([[0.0], np.cumsum(lengths)])
    return breaks * duration / breaks[-1]


def solve(
    problem: PathProblem, seed: int = 0, progress: Progress = lambda share, text: None
) -> PathPlan:
    """The plan of least self-disturbance within the limits; the same for the same seed.

    Where the limits cannot be kept, the plan breaks them least; its report says which and where.
    """
    discrete = discretise(problem, graded_breaks(problem.duration))
    schedule = Schedule()
    done = [0]

    def tick():
        done[0] += 1
        progress(min(done[0] / 40, 0.99), "whole path")

    held = np.tile(problem.start.value, (len(discrete.grid.numbers), 1))
    solution = solve_on_knots(discrete, held, schedule, tick)
    progress(1.0, "whole path")
    return PathPlan(problem, discrete.knots, solution.coefficients, solution.iterations)
