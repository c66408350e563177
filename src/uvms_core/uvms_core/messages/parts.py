"""Pieces that many messages share, as nested dicts of plain values."""

from array import array
from typing import Any

import numpy as np

from uvms_core.signals import NANOSECONDS, Array
from uvms_core.topic import Topic

Plain = dict[str, Any]


def time(stamp: int) -> Plain:
    """builtin_interfaces/Time (or Duration)."""
    sec, nanosec = divmod(stamp, NANOSECONDS)
    return {"sec": sec, "nanosec": nanosec}


def header(topic: Topic, stamp: int) -> Plain:
    """std_msgs/Header in the topic's own frame."""
    return {"stamp": time(stamp), "frame_id": topic.frame}


def vector(value: Array) -> Plain:
    """geometry_msgs/Vector3 or Point."""
    x, y, z = value.tolist()
    return {"x": x, "y": y, "z": z}


def quaternion(value: Array) -> Plain:
    """geometry_msgs/Quaternion."""
    x, y, z, w = value.tolist()
    return {"x": x, "y": y, "z": z, "w": w}


def twist(value: Array) -> Plain:
    """geometry_msgs/Twist or Accel."""
    return {"linear": vector(value[:3]), "angular": vector(value[3:])}


def wrench(value: Array) -> Plain:
    """geometry_msgs/Wrench."""
    return {"force": vector(value[:3]), "torque": vector(value[3:])}


def pose(position: Array, attitude: Array) -> Plain:
    """geometry_msgs/Pose."""
    return {"position": vector(position), "orientation": quaternion(attitude)}


def floats(value: Array) -> array:
    """float64[] in the form that rclpy takes without looking at every element."""
    return array("d", np.asarray(value, dtype=np.float64).tobytes())
