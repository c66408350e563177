"""The planner's reference to a message and back."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import Array, PlannedDisturbance, Reference, to_nanoseconds
from uvms_core.topic import Topic


def reference_to(topic: Topic, value: Reference, names: Sequence[str]) -> Plain:
    """uvms_msgs/Reference."""
    return {
        "header": parts.header(topic, value.stamp),
        "joint_names": list(names),
        "points": [_point_to(value, k) for k in range(len(value.times))],
    }


def _point_to(value: Reference, k: int) -> Plain:
    return {
        "time_from_start": parts.time(to_nanoseconds(float(value.times[k]))),
        "pose": parts.pose(value.position[k], value.quaternion[k]),
        "twist": parts.twist(value.nu[k]),
        "accel": parts.twist(value.nu_dot[k]),
        "joint_position": parts.floats(value.q[k]),
        "joint_velocity": parts.floats(value.q_dot[k]),
        "joint_acceleration": parts.floats(value.q_ddot[k]),
        "end_effector": parts.vector(value.end_effector[k]),
        "disturbance": _disturbance_to(value.disturbance, k),
    }


def _disturbance_to(value: PlannedDisturbance | None, k: int) -> list[Plain]:
    if value is None:
        return []
    both = {"restoring": value.restoring[k], "coupling": value.coupling[k]}
    return [{name: parts.wrench(wrench) for name, wrench in both.items()}]


def reference_from(topic: Topic, msg: Any, names: Sequence[str]) -> Reference:
    """From uvms_msgs/Reference; its times must increase from 0."""
    fields.check_frame(topic, msg.header)
    index = fields.order(topic, "joint_names", msg.joint_names, names)
    if not len(msg.points):
        raise SignalError(f"{topic.name}: points is empty; it must have at least one")
    count = len(msg.joint_names)
    offsets = [point.time_from_start for point in msg.points]
    times = fields.times(topic, "points[{}].time_from_start", offsets)
    if times[0] != 0.0:
        raise SignalError(
            f"{topic.name}: points[0].time_from_start is {times[0]:g} s; it must be 0"
        )
    rows = [_point_from(topic, k, point, count) for k, point in enumerate(msg.points)]
    pose, attitude, nu, nu_dot, q, q_dot, q_ddot, tool = (
        np.array(column) for column in zip(*rows, strict=True)
    )
    return Reference(
        fields.stamp_of(msg.header.stamp),
        times,
        pose,
        attitude,
        nu,
        nu_dot,
        np.ascontiguousarray(q[:, index]),
        np.ascontiguousarray(q_dot[:, index]),
        np.ascontiguousarray(q_ddot[:, index]),
        tool,
        _disturbance_from(topic, msg.points),
    )


def _point_from(topic: Topic, k: int, point: Any, count: int) -> tuple[Any, ...]:
    at = f"points[{k}]"
    pose = point.pose
    return (
        fields.xyz(topic, f"{at}.pose.position", pose.position),
        fields.quaternion(topic, f"{at}.pose.orientation", pose.orientation),
        fields.twist(topic, f"{at}.twist", point.twist),
        fields.twist(topic, f"{at}.accel", point.accel),
        fields.floats(topic, f"{at}.joint_position", point.joint_position, count),
        fields.floats(topic, f"{at}.joint_velocity", point.joint_velocity, count),
        fields.floats(topic, f"{at}.joint_acceleration", point.joint_acceleration, count),
        fields.xyz(topic, f"{at}.end_effector", point.end_effector),
    )


def _disturbance_from(topic: Topic, points: Sequence[Any]) -> PlannedDisturbance | None:
    """None where no point has one, as in logs from before this field."""
    given = [list(getattr(point, "disturbance", ())) for point in points]
    if not any(given):
        return None
    for k, found in enumerate(given):
        if len(found) != 1:
            raise SignalError(
                f"{topic.name}: points[{k}].disturbance has {len(found)} values; other points have"
                " one, so it must have one"
            )
    return PlannedDisturbance(
        *(_wrenches(topic, name, given) for name in ("restoring", "coupling"))
    )


def _wrenches(topic: Topic, name: str, given: Sequence[Sequence[Any]]) -> Array:
    at = "points[{}].disturbance[0]." + name
    rows = [
        fields.wrench(topic, at.format(k), getattr(found[0], name)) for k, found in enumerate(given)
    ]
    return np.array(rows)
