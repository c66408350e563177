"""Goals of the planner's actions to messages and back."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.rotations import matrix_to_quat, quat_multiply, quat_to_matrix
from uvms_core.signals import Array, JointGoal, PathGoal, PoseGoal, to_nanoseconds, to_seconds
from uvms_core.topic import WORLD_FRAME, Action
from uvms_core.world_frames import MAP_FRAME, R_MAP_MAP_NED


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
        "tool_axis": parts.vector(goal.tool_axis if len(goal.tool_axis) else np.zeros(3)),
        "axis_directions": [parts.vector(direction) for direction in goal.axis_directions],
        "max_time_scale": float(goal.time_scale_max),
    }


def path_from(action: Action, msg: Any, names: Sequence[str]) -> PathGoal:
    """From the goal of FollowEndEffectorPath: as many times as positions, from 0."""
    rotate = _to_map_ned(action, msg.header.frame_id)
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
    attitudes = np.array(orientations).reshape(-1, 4)
    if rotate is not None:
        attitudes = np.array([quat_multiply(rotate, attitude) for attitude in attitudes])
    axis, directions = _pointing(action, msg, count)
    return PathGoal(
        times,
        _rotated(rotate, np.array(positions)),
        attitudes.reshape(-1, 4),
        axis,
        _rotated(rotate, directions),
        _time_scale(action, msg.max_time_scale),
    )


def _to_map_ned(action: Action, frame: str) -> Array | None:
    """Quaternion (4,) of a goal's frame in map_ned; None where it is map_ned."""
    if frame == WORLD_FRAME:
        return None
    if frame == MAP_FRAME:
        return matrix_to_quat(R_MAP_MAP_NED.T)
    raise SignalError(
        f"{action.name}: header.frame_id is {frame!r}; it must be {WORLD_FRAME!r} or {MAP_FRAME!r}"
    )


def _rotated(rotate: Array | None, vectors: Array) -> Array:
    """Vectors (k, 3) of the goal's frame in map_ned; exact, since its axes are those of map_ned."""
    if rotate is None or not len(vectors):
        return vectors
    return vectors @ np.round(quat_to_matrix(rotate)).T


def _pointing(action: Action, msg: Any, count: int) -> tuple[Array, Array]:
    """The tool's axis (3,) that is to point and its directions (k, 3), unit; or (0,) and (0, 3)."""
    axis = fields.vector(action, "tool_axis", msg.tool_axis)
    if not axis.any():
        _check_length(action, "axis_directions", msg.axis_directions, (0,))
        return np.empty(0), np.empty((0, 3))
    _check_length(action, "axis_directions", msg.axis_directions, (count,))
    _check_length(action, "orientations", msg.orientations, (0,))
    rows = [
        fields.vector(action, f"axis_directions[{k}]", value)
        for k, value in enumerate(msg.axis_directions)
    ]
    directions = np.array(rows)
    lengths = np.linalg.norm(directions, axis=1, keepdims=True)
    if not lengths.all():
        raise SignalError(f"{action.name}: axis_directions[{int(np.argmin(lengths))}] is zero")
    return axis / np.linalg.norm(axis), directions / lengths


def _time_scale(action: Action, value: float) -> float:
    """How many times as long a path may take; 0, which a client leaves it at, is 1."""
    scale = fields.number(action, "max_time_scale", value) or 1.0
    if scale < 1.0:
        raise SignalError(f"{action.name}: max_time_scale is {scale:g}; it must be >= 1, or 0")
    return scale


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


def pose_to(action: Action, goal: PoseGoal, names: Sequence[str]) -> Plain:
    """Goal of GoToPose."""
    return {
        "header": _stampless(WORLD_FRAME),
        "pose": parts.pose(goal.position, goal.quaternion),
        "duration": _duration(goal.duration_s),
        "hold": _duration(goal.hold_s),
        "max_speed": float(goal.speed_max_m_s),
    }


BODY_TURN = np.array([1.0, 0.0, 0.0, 0.0])
"""Quaternion of base_link_fsd in base_link: half a turn about the axis forward."""


def pose_from(action: Action, msg: Any, names: Sequence[str]) -> PoseGoal:
    """From the goal of GoToPose; in `map` the pose is that of base_link, as REP-105 has it."""
    rotate = _to_map_ned(action, msg.header.frame_id)
    position = fields.vector(action, "pose.position", msg.pose.position)
    attitude = fields.quaternion(action, "pose.orientation", msg.pose.orientation)
    if rotate is not None:
        position = _rotated(rotate, position[None])[0]
        attitude = quat_multiply(quat_multiply(rotate, attitude), BODY_TURN)
    return PoseGoal(
        position,
        attitude,
        _seconds(action, "duration", msg.duration),
        _seconds(action, "hold", msg.hold),
        _not_negative(action, "max_speed", fields.number(action, "max_speed", msg.max_speed)),
    )


def _seconds(action: Action, path: str, value: Any) -> float:
    return _not_negative(action, path, to_seconds(fields.stamp_of(value)))


def _not_negative(action: Action, path: str, value: float) -> float:
    if value < 0.0:
        raise SignalError(f"{action.name}: {path} is {value:g}; it must be >= 0")
    return value


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
