"""Limits of the values that are judged at samples: the vehicle's motion, attitude and thrust."""

import numpy as np

from uvms_planner.constraints import free_attitude
from uvms_planner.whole_path.assembly import Bounds
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.sample import ATTITUDE, POSITION, THRUST, TURN, WRENCHES

BEYOND_PRICE = 1e-3
"""Of the free attitude where the start is beyond it: no joint is overtaxed to come back."""
AXES = ("x", "y", "z")


def sampled_bounds(problem: PathProblem, tight: float = 1.0) -> Bounds:
    """Bounds of the values of `sample` from POSITION on; those of rates and so on times `tight`."""
    limits = problem.limits
    size = THRUST - WRENCHES + len(problem.water.shares)
    upper = np.full(size, np.inf)
    at, roll = POSITION - WRENCHES, ATTITUDE - WRENCHES
    upper[at + 3 : at + 6] = limits.rate[:3]
    upper[at + 6 : at + 9] = limits.acceleration[:3]
    upper[roll : roll + 2] = limits.roll_max, limits.pitch_max
    upper[THRUST - WRENCHES :] = 1.0
    scale, price = np.where(np.isfinite(upper), upper, 1.0), np.ones(size)
    upper *= tight
    lower = -upper
    lower[at : at + 3], upper[at : at + 3] = limits.lower[:3], limits.upper[:3]
    if not starts_level(problem):
        price[roll : roll + 2] = BEYOND_PRICE
    return Bounds(lower, upper, scale, price)


def value_names(problem: PathProblem) -> list[str]:
    """What the values from POSITION on are, for people."""
    motion = [f"{what}{axis} of the vehicle" for what in ("", "rate of ", "acceleration of ")
              for axis in AXES]  # fmt: skip
    thrust = [f"thruster {k + 1}" for k in range(len(problem.water.shares))]
    return [*motion, "free roll", "free pitch", *(["turn of the tool"] * (THRUST - TURN)), *thrust]


def starts_level(problem: PathProblem) -> bool:
    """Whether the vehicle would be within its free attitude's limits at the start."""
    roll, pitch = free_attitude(problem.model, problem.start.value[1:])
    return bool(abs(roll) < problem.limits.roll_max and abs(pitch) < problem.limits.pitch_max)
