"""Readers of message fields that check what they read, and name what is wrong.

They read attributes of any message-like object (an rclpy message, a decoded log message) and raise
`SignalError` that names topic, field and value. The sum of finite numbers is finite except for
overflow, so one test of the sum is the fast way, and the slow way only names the value.
"""

from collections.abc import Iterable, Sequence
from math import isfinite
from typing import Any

import numpy as np

from uvms_core.checks import ROUNDED, is_unit
from uvms_core.errors import SignalError
from uvms_core.signals import NANOSECONDS, Array, to_seconds
from uvms_core.topic import WORLD_FRAME, Action, Topic
from uvms_core.world_frames import MAP_FRAME, R_MAP_MAP_NED

_LONGEST_ECHO = 200


def stamp_of(time: Any) -> int:
    """A builtin_interfaces Time or Duration in nanoseconds."""
    if time.nanosec >= NANOSECONDS:
        raise SignalError(f"a stamp has {time.nanosec} nanosec; it must be below {NANOSECONDS}")
    return time.sec * NANOSECONDS + time.nanosec


def _short(text: str) -> str:
    """A text from outside as far as a message can hold it."""
    return text if len(text) <= _LONGEST_ECHO else f"{text[:_LONGEST_ECHO]}..."


def check_frame(topic: Topic, header: Any) -> None:
    """The frame id must be the topic's own."""
    if header.frame_id != topic.frame:
        raise SignalError(
            f"{topic.name}: header.frame_id is {_short(header.frame_id)!r};"
            f" it must be {topic.frame!r}{_remedy(topic)}"
        )


def _remedy(topic: Topic) -> str:
    """How to have another frame id."""
    field = f"sensors.{topic.sensor}.frame_id"
    return f", or what {field} in the vehicle file says" if topic.sensor else ""


def to_map_ned(topic: Topic, header: Any) -> Array:
    """The matrix (3, 3) from the axes of a header's frame to those of map_ned.

    The frame is map_ned, map, or the topic's own.
    """
    if header.frame_id == WORLD_FRAME:
        return np.eye(3)
    if header.frame_id == MAP_FRAME:
        return R_MAP_MAP_NED.T
    if header.frame_id == topic.frame:
        return R_MAP_MAP_NED.T if topic.is_enu else np.eye(3)
    raise SignalError(
        f"{topic.name}: header.frame_id is {_short(header.frame_id)!r}; it must be"
        f" {WORLD_FRAME!r} or {MAP_FRAME!r}{_remedy(topic)}"
    )


def from_map_ned(topic: Topic) -> Array:
    """The matrix (3, 3) from the axes of map_ned to those of the topic's frame of the world."""
    is_enu = topic.frame == MAP_FRAME or (topic.frame != WORLD_FRAME and topic.is_enu)
    return R_MAP_MAP_NED if is_enu else np.eye(3)


def check_child_frame(topic: Topic, frame: str) -> None:
    """The child frame id must be the topic's own."""
    if frame != topic.child_frame:
        raise SignalError(
            f"{topic.name}: child_frame_id is {_short(frame)!r}; it must be {topic.child_frame!r}"
        )


def _refuse(name: str, labels: Iterable[str], values: Iterable[float]) -> None:
    for label, value in zip(labels, values, strict=True):
        if not isfinite(value):
            raise SignalError(f"{name}: {label} is {value}; it must be finite")


def number(topic: Topic | Action, path: str, value: float) -> float:
    """One finite number."""
    if not isfinite(value):
        _refuse(topic.name, (path,), (value,))
    return value


def xyz(topic: Topic | Action, path: str, value: Any) -> tuple[float, float, float]:
    """The components of a Point or Vector3, finite."""
    x, y, z = value.x, value.y, value.z
    if not isfinite(x + y + z):
        _refuse(topic.name, (f"{path}.x", f"{path}.y", f"{path}.z"), (x, y, z))
    return x, y, z


def vector(topic: Topic | Action, path: str, value: Any) -> Array:
    """A Point or Vector3 as an array (3,), finite."""
    return np.array(xyz(topic, path, value))


def pair(
    topic: Topic | Action, path: str, first: Any, second: Any, labels: tuple[str, str]
) -> Array:
    """Two Vector3 (linear and angular, force and torque) as one array (6,), finite."""
    head = xyz(topic, f"{path}.{labels[0]}", first)
    return np.array(head + xyz(topic, f"{path}.{labels[1]}", second))


def twist(topic: Topic | Action, path: str, value: Any) -> Array:
    """A Twist or Accel as an array (6,)."""
    return pair(topic, path, value.linear, value.angular, ("linear", "angular"))


def wrench(topic: Topic | Action, path: str, value: Any) -> Array:
    """A Wrench as an array (6,)."""
    return pair(topic, path, value.force, value.torque, ("force", "torque"))


def quaternion(topic: Topic | Action, path: str, value: Any) -> Array:
    """A Quaternion as an array (4,), finite and of unit length."""
    x, y, z, w = value.x, value.y, value.z, value.w
    squared = x * x + y * y + z * z + w * w
    if not is_unit(squared):
        _refuse(topic.name, [f"{path}.{axis}" for axis in "xyzw"], (x, y, z, w))
        raise SignalError(f"{topic.name}: {path} has length {squared**0.5:g}; it must be 1")
    return np.array((x, y, z, w))


def rounded_quaternion(topic: Topic, path: str, value: Any) -> Array:
    """As `quaternion`, of a driver that rounds: one that is nearly of unit length is made so."""
    found = np.array((value.x, value.y, value.z, value.w))
    length = float(np.linalg.norm(found))
    if not abs(length - 1.0) < ROUNDED:
        return quaternion(topic, path, value)  # says what is wrong with it
    return found if is_unit(length**2) else found / length


def floats(topic: Topic | Action, path: str, values: Any, count: int) -> Array:
    """A sequence of floats as an array (count,), finite."""
    array = np.array(values, dtype=np.float64)
    if array.shape != (count,):
        raise SignalError(f"{topic.name}: {path} has {array.size} values; it must have {count}")
    if not isfinite(array.dot(array)):
        _refuse(topic.name, (f"{path}[{i}]" for i in range(count)), array.tolist())
    return array


def covariance(topic: Topic | Action, path: str, values: Any, size: int) -> Array:
    """A row-major covariance as an array (size, size), finite."""
    return floats(topic, path, values, size * size).reshape(size, size)


UNKNOWN = -1.0
"""First element of a covariance that is not known, as sensor_msgs has it; all zeros mean the same
there."""


def stated_covariance(topic: Topic | Action, path: str, values: Any, size: int) -> Array:
    """As `covariance`; all zeros where the message says that it does not know it."""
    found = covariance(topic, path, values, size)
    return np.zeros((size, size)) if found[0, 0] == UNKNOWN else found


def order(topic: Topic | Action, path: str, given: Sequence[str], names: Sequence[str]) -> Any:
    """Index that brings values given by name into the order of `names`; a slice if it is theirs.

    No `names` leaves the order as it is.
    """
    if not names or list(given) == list(names):
        return slice(None)
    if sorted(given) != sorted(names):
        raise SignalError(
            f"{topic.name}: {path} is {_short(', '.join(given)) or '(empty)'}; "
            f"it must name {', '.join(names)}"
        )
    where = {name: index for index, name in enumerate(given)}
    return [where[name] for name in names]


def times(topic: Topic | Action, path: str, durations: Sequence[Any]) -> Array:
    """Durations in seconds, which must increase; `path` has {} for the index."""
    values = np.array([to_seconds(stamp_of(duration)) for duration in durations])
    for k in np.flatnonzero(np.diff(values) <= 0.0)[:1] + 1:
        raise SignalError(
            f"{topic.name}: {path.format(k)} is {values[k]:g} s, after {values[k - 1]:g} s; "
            "times must increase"
        )
    return values
