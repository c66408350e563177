"""Messages to bytes and back: our CDR codec against mcap_ros2 and rclpy."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from mcap_ros2._dynamic import generate_dynamic, serialize_dynamic
from metrics import Metric, Target
from paired import paired
from rclpy.serialization import deserialize_message, serialize_message

from uvms_core import topics
from uvms_core.cdr import codec, schema_text
from uvms_core.messages import from_message, to_message
from uvms_core.ros.convert import message_class, to_ros
from uvms_core.signals import Odometry, Reference
from uvms_core.topics import Topic

JOINTS = ("swing", "shoulder", "elbow", "wrist")
MCAP = "mcap_ros2"
RCLPY = "rclpy"
BOTH = {MCAP: 1.0, RCLPY: 1.0}


def measure(full: bool) -> Iterator[Metric]:
    """A short, frequent message and a long, rare one, each way.

    mcap_ros2 gets lists of numbers, which it needs, made beforehand. rclpy gets a message that is
    filled beforehand; `..._from_signal` includes the filling, on both sides.
    """
    for topic, signal in ((topics.ODOMETRY, _odometry()), (topics.REFERENCE, _reference())):
        short = topic.type.rsplit("/", 1)[-1].lower()
        yield from _metrics(f"cdr_{short}_encode", _encoders(topic, signal), BOTH)
        yield from _metrics(f"cdr_{short}_decode", _decoders(topic, signal), BOTH)
        yield from _metrics(f"cdr_{short}_from_signal", _from_signal(topic, signal), {RCLPY: 1.0})


def _metrics(name: str, sides: dict[str, Callable[[], Any]], bounds) -> Iterator[Metric]:
    ours, *others = sides
    timing = paired(sides[ours], {other: sides[other] for other in others}, rounds=15)
    for other in others:
        yield Metric(
            f"{name}_against_{other}", 1e6 * timing.seconds, "us", other, timing.ratio[other],
            Target("ratio", "<=", bounds[other]),
        )  # fmt: skip


def _encoders(topic: Topic, signal: Any) -> dict[str, Callable[[], Any]]:
    message = to_message(topic, signal, JOINTS)
    plain, ros = _plain(message), to_ros(message_class(topic), message)
    theirs = serialize_dynamic(topic.type, schema_text(topic.type))[topic.type]
    ours = codec(topic.type).encode
    if ours(message) != theirs(plain):
        raise ArithmeticError(f"{topic.type}: the bytes differ")
    return {
        "ours": lambda: ours(message),
        MCAP: lambda: theirs(plain),
        RCLPY: lambda: serialize_message(ros),
    }


def _decoders(topic: Topic, signal: Any) -> dict[str, Callable[[], Any]]:
    data = codec(topic.type).encode(to_message(topic, signal, JOINTS))
    theirs = generate_dynamic(topic.type, schema_text(topic.type))[topic.type]
    ours, cls = codec(topic.type).decode, message_class(topic)
    return {
        "ours": lambda: ours(data),
        MCAP: lambda: theirs(data),
        RCLPY: lambda: deserialize_message(data, cls),
    }


def _from_signal(topic: Topic, signal: Any) -> dict[str, Callable[[], Any]]:
    """The path of a node's output, from the dataclass to the bytes, and back for its input."""
    ours, cls = codec(topic.type), message_class(topic)

    def raw() -> Any:
        data = ours.encode(to_message(topic, signal, JOINTS))
        return from_message(topic, ours.decode(data), JOINTS)

    def usual() -> Any:
        data = serialize_message(to_ros(cls, to_message(topic, signal, JOINTS)))
        return from_message(topic, deserialize_message(data, cls), JOINTS)

    return {"ours": raw, RCLPY: usual}


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    return value.tolist() if hasattr(value, "tolist") else value


def _odometry() -> Odometry:
    rng = np.random.default_rng(1)
    level = np.array([0.0, 0.0, 0.0, 1.0])
    return Odometry(
        1, rng.normal(size=3), level, *(rng.normal(size=s) for s in (6, (6, 6), (6, 6)))
    )


def _reference(count: int = 11) -> Reference:
    rng = np.random.default_rng(2)
    level = np.tile([0.0, 0.0, 0.0, 1.0], (count, 1))
    position, tool = rng.normal(size=(2, count, 3))
    vehicle = rng.normal(size=(2, count, 6))
    joints = rng.normal(size=(3, count, len(JOINTS)))
    return Reference(1, 0.05 * np.arange(count), position, level, *vehicle, *joints, tool)
