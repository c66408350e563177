"""Why a path cannot be followed with the orientation that it prescribes, and what can be asked."""

from contextlib import suppress

import numpy as np

from uvms_core import registry
from uvms_core.errors import PluginError
from uvms_core.signals import Array
from uvms_planner.errors import GoalRejected
from uvms_planner.whole_path import PathPlan, PathProblem
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import solve_on_knots
from uvms_planner.whole_path.orientation_reach import hard_turn, orientation_gap
from uvms_planner.whole_path.pieces import coarse_breaks
from uvms_planner.whole_path.relaxed_path import relaxed
from uvms_planner.whole_path.solve import THOROUGH, posture_held, size_of

HARD = 0.15
"""rad of turn per rad of yaw and joints, below which a posture is called singular."""


def refuse_axis(method: str) -> None:
    """Raise GoalRejected for a method that plans step by step: which methods follow a tool_axis."""
    able = []
    for name in registry.names(registry.PLANNERS):
        with suppress(PluginError):  # of somebody else's package: not what was asked for
            if hasattr(registry.load(registry.PLANNERS, name), "plan_path"):
                able.append(name)
    raise GoalRejected(
        f"path: the method {method} follows no tool_axis; planner.method {' or '.join(able)} does,"
        " or give whole orientations, or none"
    )


def refuse_out_of_reach(problem: PathProblem) -> None:
    """Raise GoalRejected where the orientation is out of reach at any speed: which turn, when."""
    gap = orientation_gap(problem) if problem.tool.oriented else None
    if gap is None:
        return
    what = "orientation" if _is_full(problem) else "direction of tool_axis"
    raise GoalRejected(
        f"path: from t = {gap.first:.4g} s on its {what} is out of reach: at t = {gap.time:.4g} s"
        " the nearest that the limits of joints, depth, roll and pitch allow is"
        f" {np.rad2deg(gap.angle):.4g} deg away, allowed {np.rad2deg(problem.turn_tolerance):g}"
        f" deg, most of it {_about(problem, gap.turn)}; {what_can_be_followed(problem, gap.turn)}"
    )


def reason_of(plan: PathPlan) -> str:
    """The limit that a plan exceeds most and, where its posture there is singular, what of it."""
    problem, worst = plan.problem, plan.report.worst
    if not problem.tool.oriented:
        return str(worst)
    gain, axis = hard_turn(problem, worst.time, plan.posture(np.array([worst.time]))[0, 0])
    if gain > HARD:
        return str(worst)
    return (
        f"{worst}, in a posture that is singular: yaw and joints hardly turn the tool"
        f" {_about(problem, axis)}; {what_can_be_followed(problem, axis)}"
    )


def what_can_be_followed(problem: PathProblem, hard: Array) -> str:
    """With how much less asked of the orientation the path can be followed as fast as it is.

    Of the tool's axes the one is preferred about which most of the turn `hard` (3,) is.
    """
    found = []
    if _is_full(problem):
        axes = np.eye(3)[np.argsort(-np.abs(hard), kind="stable")]
        able = (axis for axis in axes if _feasible(relaxed(problem, axis)))
        found = [f"orientation axis, tool_axis {axis.astype(int).tolist()}" for axis in able][:1]
    if _feasible(relaxed(problem)):
        found.append("orientation free")
    if not found:
        return "with orientation free it cannot be followed either"
    return f"it can be followed with {', or with '.join(found)}"


def _feasible(problem: PathProblem) -> bool:
    """Whether a plan on the coarse pieces keeps the limits: what it does a fine one can do."""
    if problem.tool.oriented and orientation_gap(problem) is not None:
        return False
    coarse = discretise(problem, coarse_breaks(problem))
    held = posture_held(coarse)
    found = solve_on_knots(coarse, held, THOROUGH.scaled(size_of(coarse, held)))
    return PathPlan(problem, coarse.knots, found.coefficients, 0).report.feasible


def _is_full(problem: PathProblem) -> bool:
    return bool(len(problem.target(np.zeros(1)).rotation))


def _about(problem: PathProblem, turn: Array) -> str:
    """About which axis most of a turn (3,) is."""
    largest = int(np.argmax(np.abs(turn)))
    if _is_full(problem):
        return f"about the tool's {'xyz'[largest]} axis"
    return f"about the axis {('north', 'east', 'down')[largest]}"
