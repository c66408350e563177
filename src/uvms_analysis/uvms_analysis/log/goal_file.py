"""The path of a run as the attachment `path.json` of its log."""

import json

import numpy as np

from uvms_analysis.errors import LogError
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.errors import UvmsError
from uvms_core.signals import PathGoal

NAME = "path.json"


def path_to_json(goal: PathGoal) -> str:
    """Times in s after the start, positions in m (map_ned), orientations x, y, z, w, and more."""
    return json.dumps(
        {
            "times": goal.times.tolist(),
            "positions": goal.positions.tolist(),
            "orientations": goal.orientations.tolist(),
            "tool_axis": goal.tool_axis.tolist(),
            "axis_directions": goal.axis_directions.tolist(),
            "time_scale_max": goal.time_scale_max,
        }
    )


def path_from_json(text: str) -> PathGoal:
    """The goal back, every float exact.

    Raises:
        LogError: the text is not such a path.
    """
    try:
        data = json.loads(text)
        times = np.array(data["times"], dtype=np.float64)
        positions = np.array(data["positions"], dtype=np.float64).reshape(len(times), 3)
        orientations = np.array(data["orientations"], dtype=np.float64).reshape(-1, 4)
        # Older logs have none of these.
        axis = np.array(data.get("tool_axis", []), dtype=np.float64)
        directions = np.array(data.get("axis_directions", []), dtype=np.float64).reshape(-1, 3)
        scale = float(data.get("time_scale_max", 1.0))
    except (ValueError, KeyError, TypeError) as fault:
        raise LogError(f"{NAME}: is not a path of the end effector: {fault}") from fault
    goal = PathGoal(times, positions, orientations, axis, directions, scale)
    try:
        EndEffectorPath(goal)
    except (UvmsError, ValueError, IndexError) as fault:
        raise LogError(f"{NAME}: is not a path of the end effector: {fault}") from fault
    return goal
