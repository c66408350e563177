"""The best plan over a whole path that can be found: a search for the basin, then the optimum."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import Schedule, solve_on_knots
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.plan import PathPlan


class Pieces(NamedTuple):
    """How a path is cut into the spline's pieces."""

    first: float  # s; a posture that is left quickly needs fine pieces
    growth: float  # from one piece to the next
    count: int  # of a path of medium length
    least: float  # s, of the pieces after the beginning
    greatest: float  # s


COARSE = Pieces(first=0.4, growth=1.4, count=50, least=2.0, greatest=12.0)
SPLIT = 4  # fine pieces of a coarse one: what the coarse spline is, the fine one can be

Progress = Callable[[float, str], None]


def graded_breaks(duration: float, pieces: Pieces) -> Array:
    """Ends of the pieces (b,), s: fine at the beginning, even later."""
    spacing = float(np.clip(duration / pieces.count, pieces.least, pieces.greatest))
    lengths = [min(pieces.first, duration / 8)]
    while sum(lengths) < duration:
        lengths.append(min(lengths[-1] * pieces.growth, spacing))
    breaks = np.concatenate([[0.0], np.cumsum(lengths)])
    return breaks * duration / breaks[-1]


def split(breaks: Array, parts: int) -> Array:
    """The same ends, and those of each piece's equal parts."""
    shares = np.arange(parts) / parts
    inner = breaks[:-1, None] + np.diff(breaks)[:, None] * shares
    return np.append(inner.ravel(), breaks[-1])


def solve(
    problem: PathProblem, seed: int = 0, progress: Progress = lambda share, text: None
) -> PathPlan:
    """The plan of least self-disturbance within the limits; the same for the same seed.

    Where the limits cannot be kept, the plan breaks them least; its report says which and where.
    """
    coarse = discretise(problem, graded_breaks(problem.duration, COARSE))
    fine = discretise(problem, split(graded_breaks(problem.duration, COARSE), SPLIT))
    progress(0.0, "coarse plan")
    held = np.tile(problem.start.value, (len(coarse.grid.numbers), 1))
    rough = solve_on_knots(coarse, held, Schedule())
    progress(0.3, "whole path")
    begin = fine.taken_from(coarse.knots, rough.coefficients)
    solution = solve_on_knots(fine, begin, Schedule(barriers=(1e-3, 1e-4, 1e-5)))
    progress(1.0, "whole path")
    return PathPlan(problem, fine.knots, solution.coefficients, solution.iterations)
