"""Why a path with a prescribed orientation cannot be followed, and what would make it possible."""

import numpy as np

from uvms_core.signals import Array
from uvms_planner.whole_path import PathPlan, PathProblem, solve
from uvms_planner.whole_path.orientation_reach import hard_turn, orientation_gap
from uvms_planner.whole_path.relaxed_path import relaxed

HARD = 0.15
"""rad of turn per rad of yaw and joints, below which a posture is called singular."""


def orientation_out_of_reach(problem: PathProblem) -> str | None:
    """Which turn of the tool is out of reach at any speed, and when; None where none is."""
    gap = orientation_gap(problem) if problem.tool.oriented else None
    if gap is None:
        return None
    allowed = np.rad2deg(problem.turn_tolerance)
    return (
        f"from t = {gap.first:.4g} s on its {_what(problem)} is out of reach: at t ="
        f" {gap.time:.4g} s the nearest that the limits of joints, depth, roll and pitch allow is"
        f" {np.rad2deg(gap.angle):.4g} deg away, allowed {allowed:g} deg, most of it"
        f" {_about(problem, gap.turn)}; {what_can_be_followed(problem)}"
    )


def singular_posture(plan: PathPlan, time: float) -> str | None:
    """What the tool can hardly do in the plan at `time` s, where its orientation is prescribed."""
    problem = plan.problem
    if not problem.tool.oriented:
        return None
    gain, axis = hard_turn(problem, time, plan.posture(np.array([time]))[0, 0])
    if gain > HARD:
        return None
    return (
        f"the posture there is singular: yaw and joints can hardly turn the tool"
        f" {_about(problem, axis)}; {what_can_be_followed(problem)}"
    )


def what_can_be_followed(problem: PathProblem) -> str:
    """With how much less asked of the orientation the path can be followed as fast as it is."""
    found = []
    if len(problem.target(np.zeros(1)).rotation):
        found = [_axis_word(axis) for axis in np.eye(3) if _feasible(relaxed(problem, axis))][:1]
    if _feasible(relaxed(problem)):
        found.append("orientation free")
    if not found:
        return "it cannot be followed with the orientation free either"
    return f"it can be followed with {' or with '.join(found)}"


def _feasible(problem: PathProblem) -> bool:
    if problem.tool.oriented and orientation_gap(problem) is not None:
        return False
    return solve(problem).report.feasible


def _what(problem: PathProblem) -> str:
    return "orientation" if len(problem.target(np.zeros(1)).rotation) else "direction of tool_axis"


def _axis_word(axis: Array) -> str:
    return f"orientation axis, tool_axis {[int(part) for part in axis]}"


def _about(problem: PathProblem, turn: Array) -> str:
    """About which axis most of a turn (3,) is."""
    largest = int(np.argmax(np.abs(turn)))
    if len(problem.target(np.zeros(1)).rotation):
        return f"about the tool's {'xyz'[largest]} axis"
    return f"about {('north', 'east', 'down')[largest]}"
