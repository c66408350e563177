"""The clock and the diagnostics to messages and back."""

from collections.abc import Sequence
from typing import Any

from uvms_core.diagnostics import Status
from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import SensorGaps
from uvms_core.topic import Topic


def clock_to(topic: Topic, stamp: int, names: Sequence[str]) -> Plain:
    """rosgraph_msgs/Clock."""
    return {"clock": parts.time(stamp)}


def clock_from(topic: Topic, msg: Any, names: Sequence[str]) -> int:
    """From rosgraph_msgs/Clock."""
    return fields.stamp_of(msg.clock)


def gaps_to(topic: Topic, gaps: SensorGaps, names: Sequence[str]) -> Plain:
    """uvms_msgs/SensorGaps."""
    return {
        "header": parts.header(topic, gaps.stamp),
        "sensors": list(gaps.sensors),
        "newest": list(gaps.newest),
    }


def gaps_from(topic: Topic, msg: Any, names: Sequence[str]) -> SensorGaps:
    """From uvms_msgs/SensorGaps."""
    fields.check_frame(topic, msg.header)
    sensors, newest = tuple(map(str, msg.sensors)), tuple(map(int, msg.newest))
    if len(sensors) != len(newest):
        raise SignalError(
            f"{topic.name}: has {len(newest)} stamps for {len(sensors)} sensors; needs one each"
        )
    return SensorGaps(fields.stamp_of(msg.header.stamp), sensors, newest)


def status_to(topic: Topic, status: Status, names: Sequence[str]) -> Plain:
    """diagnostic_msgs/DiagnosticArray with one status.

    The level is an integer here; rclpy wants a `byte` field as `bytes([level])`.
    """
    values = [{"key": key, "value": _text(value)} for key, value in status.values.items()]
    one = {
        "level": status.level,
        "name": status.name,
        "message": status.message,
        "hardware_id": status.run_id,
        "values": values,
    }
    return {"header": parts.header(topic, status.stamp), "status": [one]}


def _text(value: float | int | bool | str) -> str:
    return value if isinstance(value, str) else repr(value)


def status_from(topic: Topic, msg: Any, names: Sequence[str]) -> Status:
    """From diagnostic_msgs/DiagnosticArray with one status."""
    if len(msg.status) != 1:
        raise SignalError(f"{topic.name}: status has {len(msg.status)} values; it must have 1")
    one = msg.status[0]
    level = one.level[0] if isinstance(one.level, bytes) else one.level
    values = {item.key: item.value for item in one.values}
    stamp = fields.stamp_of(msg.header.stamp)
    return Status(stamp, one.name, level, one.message, values, one.hardware_id)
