"""Goals of the planner's actions to messages and back."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import JointGoal, PathGoal, to_nanoseconds
from uvms_core.topic import WORLD_FRAME, Action


def _stampless(frame: str) -> Plain:
    return {"stamp": parts.time(0), "frame_id": frame}


def _duration(seconds: float) -> Plain:
    return parts.time(to_nanoseconds(seconds))


def path_to(action: Action, goal: PathGoal, names: Sequence[str]) -> Plain:
    """Goal of FollowEndEffectorPath."""
    return {
        "header": _stampless(WORLD_FRAME),
        "time_from_start": [_duration(time) for time in goal.times.tolist()],
        "positions": [parts.vector(position) for position in goal.positions],
        "orientations": [parts.quaternion(attitude) for attitude in goal.orientations],
    }


def path_from(action: Action, msg: Any, names: Sequence[str]) -> PathGoal:
    """From the goal of FollowEndEffectorPath: as many times as positions, from 0."""
    if msg.header.frame_id != WORLD_FRAME:
        raise SignalError(
            f"{action.name}: header.frame_id is {msg.header.frame_id!r}; it must be {WORLD_FRAME!r}"
        )
    count = _count(action, "positions", msg.positions)
    _check_length(action, "time_from_start", msg.time_from_start, (count,))
    _check_length(action, "orientations", msg.orientations, (0, count))
    times = fields.times(action, "time_from_start[{}]", msg.time_from_start)
    if times[0] != 0.0:
        raise SignalError(f"{action.name}: time_from_start[0] is {times[0]:g} s; it must be 0")
    positions = [
        fields.xyz(action, f"positions[{k}]", point) for k, point in enumerate(msg.positions)
    ]
    orientations = [
        fields.quaternion(action, f"orientations[{k}]", value)
        for k, value in enumerate(msg.orientations)
    ]
    return PathGoal(times, np.array(positions), np.array(orientations).reshape(-1, 4))


def joints_to(action: Action, goal: JointGoal, names: Sequence[str]) -> Plain:
    """Goal of FollowJointTrajectory."""
    empty = parts.floats(np.empty(0))
    points = [
        {
            "positions": parts.floats(position),
            "velocities": empty,
            "accelerations": empty,
            "effort": empty,
            "time_from_start": _duration(time),
        }
        for time, position in zip(goal.times.tolist(), goal.positions, strict=True)
    ]
    trajectory = {"header": _stampless(""), "joint_names": list(names), "points": points}
    return {"trajectory": trajectory}


def joints_from(action: Action, msg: Any, names: Sequence[str]) -> JointGoal:
    """From the goal of FollowJointTrajectory; times are positive and increase."""
    trajectory = msg.trajectory
    _count(action, "trajectory.points", trajectory.points)
    index = fields.order(action, "trajectory.joint_names", trajectory.joint_names, names)
    offsets = [point.time_from_start for point in trajectory.points]
    path = "trajectory.points[{}].time_from_start"
    times = fields.times(action, path, offsets)
    if times[0] <= 0.0:
        raise SignalError(f"{action.name}: {path.format(0)} is {times[0]:g} s; it must be > 0")
    count = len(trajectory.joint_names)
    positions = [
        fields.floats(action, f"trajectory.points[{k}].positions", point.positions, count)
        for k, point in enumerate(trajectory.points)
    ]
    return JointGoal(times, np.ascontiguousarray(np.array(positions)[:, index]))


def _count(action: Action, path: str, values: Sequence[Any]) -> int:
    if not len(values):
        raise SignalError(f"{action.name}: {path} is empty; it must have at least one")
    return len(values)


def _check_length(
    action: Action, path: str, values: Sequence[Any], allowed: tuple[int, ...]
) -> None:
    if len(values) not in allowed:
        choices = " or ".join(str(count) for count in allowed)
        raise SignalError(f"{action.name}: {path} has {len(values)} values; it must have {choices}")
