"""Targets of the end effector to messages and back."""

from collections.abc import Sequence
from typing import Any

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import ToolTarget
from uvms_core.topic import Topic


def target_to(topic: Topic, target: ToolTarget, names: Sequence[str]) -> Plain:
    """geometry_msgs/PointStamped in map_ned."""
    return {"header": parts.header(topic, target.stamp), "point": parts.vector(target.position)}


def target_from(topic: Topic, msg: Any, names: Sequence[str]) -> ToolTarget:
    """From geometry_msgs/PointStamped in map_ned, or in map (east, north, up)."""
    R = fields.to_map_ned(topic, msg.header)
    point = fields.vector(topic, "point", msg.point)
    return ToolTarget(fields.stamp_of(msg.header.stamp), R @ point)
