"""Limits of the values that are judged at samples: the vehicle's motion, attitude and thrust."""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_dynamics.kernels.clearance import clearances_of
from uvms_planner.constraints import free_attitude
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.whole_path.assembly import Bounds
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.sample import (
    ATTITUDE,
    MANIPULABILITY,
    POSITION,
    THRUST,
    TURN,
    WRENCHES,
)

BEYOND_PRICE = 1e-3
"""Of the free attitude where the start is beyond it: no joint is overtaxed to come back."""
SLIGHT = 0.5  # share of a thruster's limit below which a plan need not care
CLOSER_M = 1e-4  # than at the start, for rounding
CLEARANCE_M = 0.1  # m, what counts as one share of a clearance
AXES = ("x", "y", "z")


def sampled_bounds(problem: PathProblem, tight: float = 1.0) -> Bounds:
    """Bounds of the values of `sample` from POSITION on; those of rates and so on times `tight`."""
    limits = problem.limits
    around = problem.around
    thrusters, pairs = len(around.shares), len(around.margins)
    size, clear = THRUST - WRENCHES + thrusters + pairs, THRUST - WRENCHES + thrusters
    upper = np.full(size, np.inf)
    at, roll = POSITION - WRENCHES, ATTITUDE - WRENCHES
    upper[at + 3 : at + 6] = limits.rate[:3]
    upper[at + 6 : at + 9] = limits.acceleration[:3]
    upper[roll : roll + 2] = limits.roll_max, limits.pitch_max
    upper[THRUST - WRENCHES : clear] = 1.0
    scale, price = np.where(np.isfinite(upper), upper, 1.0), np.ones(size)
    upper *= tight
    lower, floor = -upper, np.full(size, -np.inf)
    lower[THRUST - WRENCHES : clear], floor[THRUST - WRENCHES : clear] = -np.inf, SLIGHT
    lower[at : at + 3], upper[at : at + 3] = limits.lower[:3], limits.upper[:3]
    lower[clear:] = np.minimum(around.margins, _clearances_at_start(problem))
    scale[clear:] = CLEARANCE_M
    if not starts_level(problem):
        price[roll : roll + 2] = BEYOND_PRICE
    return Bounds(lower, upper, scale, floor, price)


def value_names(problem: PathProblem) -> list[tuple[str, str]]:
    """What the values from POSITION on are, for people, and their units."""
    motion = [(f"{what}{axis} of the vehicle", unit)
              for what, unit in (("", "m"), ("rate of ", "m/s"), ("acceleration of ", "m/s^2"))
              for axis in AXES]  # fmt: skip
    return [
        *motion,
        ("free roll", "rad"),
        ("free pitch", "rad"),
        *([("turn of the tool", "rad")] * (MANIPULABILITY - TURN)),
        ("manipulability", ""),
        *((f"thruster {k + 1}", "") for k in range(len(problem.around.shares))),
        *((f"clearance {k + 1}", "m") for k in range(len(problem.around.margins))),
    ]


def starts_level(problem: PathProblem) -> bool:
    """Whether the vehicle would be within its free attitude's limits at the start."""
    roll, pitch = free_attitude(problem.model, problem.start.value[1:])
    return bool(abs(roll) < problem.limits.roll_max and abs(pitch) < problem.limits.pitch_max)


def _clearances_at_start(problem: PathProblem) -> Array:
    """Clearances (pairs,) of the start, m: what is too close may stay as close."""
    if not len(problem.around.margins):
        return np.zeros(0)
    value = problem.start.value
    position = problem.target(np.zeros(1)).position[0] - tool_offset(problem.model, value)
    configuration = np.concatenate([position, value])
    return clearances_of(problem.model, problem.around.shapes, configuration) - CLOSER_M


def tool_offset(model: Model, posture: Array) -> Array:
    """The tool (3,) from the vehicle, world axes, m, in a posture (d,)."""
    return tool_pose(model, np.concatenate([np.zeros(VEHICLE - 1), posture]))[0]
