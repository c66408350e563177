"""How a path is cut into the pieces of the spline."""

import numpy as np

from uvms_core.signals import Array
from uvms_planner.whole_path.path_problem import PathProblem

FIRST_S = 0.4
"""The first piece: a posture that makes a moment is left as quickly as the limits allow."""
GROWTH = 1.4  # from one piece to the next
PIECES = 50  # of a path that the tool goes evenly, at least
PIECES_OF_TURN = 15  # of a turn, if the tool goes round
SHORTEST_S, LONGEST_S = 0.3, 12.0  # of the pieces after the beginning
READINGS = 2000  # of the tool's motion
SPLIT = 4  # fine pieces of a coarse one: what the coarse spline is, the fine one can be


def coarse_breaks(problem: PathProblem) -> Array:
    """Ends of the pieces (b,), s: fine at the beginning, even later."""
    duration = problem.duration
    longest = min(duration / PIECES, turn_time(problem) / PIECES_OF_TURN)
    spacing = float(np.clip(longest, SHORTEST_S, LONGEST_S))
    lengths: list[float] = []
    total = 0.0
    while total < duration:
        following = lengths[-1] * GROWTH if lengths else min(FIRST_S, duration / 8)
        lengths.append(min(following, spacing))
        total += lengths[-1]
    breaks = np.concatenate([[0.0], np.cumsum(lengths)])
    return breaks * duration / breaks[-1]


def fine_breaks(coarse: Array) -> Array:
    """The same ends, and those of each piece's equal parts."""
    shares = np.arange(SPLIT) / SPLIT
    inner = coarse[:-1, None] + np.diff(coarse)[:, None] * shares
    return np.append(inner.ravel(), coarse[-1])


def turn_time(problem: PathProblem) -> float:
    """Time of a turn of the circle that has the path's mean speed and acceleration, s."""
    target = problem.target(np.linspace(0.0, problem.duration, READINGS))
    speed, bend = (np.sqrt(np.mean(x**2)) for x in (target.velocity, target.acceleration))
    return float(2 * np.pi * speed / bend) if bend > 0.0 else np.inf
