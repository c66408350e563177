"""Bad messages of every kind, made from a good one."""

import struct
from collections.abc import Callable
from typing import Any

import numpy as np

from uvms_core.cdr import codec
from uvms_core.messages import from_message, to_message
from uvms_core.topics import Topic

Rng = np.random.Generator
NUMBERS = (np.nan, np.inf, -np.inf, 1e30, -1e30, 1e300, -1e300, 1e3, 100.0, 1e-320)
HOUR = 3600 * 10**9
HEADER = b"\x00\x01\x00\x00"


def random_bytes(rng: Rng, good: bytes) -> bytes:
    """Bytes at random: any, with a right beginning, or a good message with some changed."""
    kind = rng.integers(3)
    if kind == 0:
        return rng.bytes(int(rng.integers(0, 400)))
    if kind == 1:
        return HEADER + rng.bytes(int(rng.integers(0, 1500)))
    data = bytearray(good)
    for _ in range(int(rng.integers(1, 12))):
        data[int(rng.integers(len(data)))] = int(rng.integers(256))
    return bytes(data)


def structured(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    """A message that is wrong in one way."""
    make = _WAYS[int(rng.integers(len(_WAYS)))]
    return make(rng, topic, good, names)


def _message(topic: Topic, good: bytes, names: tuple[str, ...]) -> dict[str, Any]:
    signal = from_message(topic, codec(topic.type).decode(good), names)
    return to_message(topic, signal, names)


def _encoded(topic: Topic, message: dict[str, Any]) -> bytes:
    return codec(topic.type).encode(message)


def _leaves(value: Any, found: list[tuple[Any, Any]]) -> list[tuple[Any, Any]]:
    items = value.items() if isinstance(value, dict) else enumerate(value)
    for key, item in items:
        if isinstance(item, dict | list):
            _leaves(item, found)
        elif isinstance(item, float):
            found.append((value, key))
        elif hasattr(item, "__len__") and not isinstance(item, str):
            found.extend((item, index) for index in range(len(item)))
    return found


def _wrong_number(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    message = _message(topic, good, names)
    leaves = _leaves(message, [])
    for _ in range(int(rng.integers(1, 4))):
        where, key = leaves[int(rng.integers(len(leaves)))]
        where[key] = NUMBERS[int(rng.integers(len(NUMBERS)))]
    return _encoded(topic, message)


def _every_number(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    message = _message(topic, good, names)
    number = NUMBERS[int(rng.integers(len(NUMBERS)))]
    for where, key in _leaves(message, []):
        where[key] = number
    return _encoded(topic, message)


def _wrong_stamp(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    sec, nanosec = struct.unpack_from("<iI", good, 4)
    stamp = sec * 10**9 + nanosec
    stamps = (
        stamp + HOUR, stamp - HOUR, stamp, 0, 1_700_000_000 * 10**9, stamp + 10**9,
        stamp - 5 * 10**9, stamp + int(rng.integers(-(10**9), 10**9)), stamp + 50_000_000,
    )  # fmt: skip
    chosen = stamps[int(rng.integers(len(stamps)))]
    data = bytearray(good)
    struct.pack_into("<iI", data, 4, chosen // 10**9, chosen % 10**9)
    if rng.integers(10) == 0:
        struct.pack_into("<I", data, 8, int(rng.integers(10**9, 2**32)))
    return bytes(data)


def _wrong_text(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    message = _message(topic, good, names)
    texts = ("", "map", "base_link", "x" * 5000, "é" * 20)
    message["header"]["frame_id"] = texts[int(rng.integers(len(texts)))]
    for field in ("name", "joint_names", "child_frame_id"):
        if field in message and rng.integers(2):
            given = message[field]
            message[field] = "odom" if isinstance(given, str) else [*given[1:], "nobody"]
            message["header"]["frame_id"] = topic.frame
    return _encoded(topic, message)


def _wrong_size(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    """A sequence too short, too long or empty, where the type has one."""
    message = _message(topic, good, names)
    sequences = [
        key for key, value in message.items()
        if not isinstance(value, dict | str | float | int) and len(value)
    ]  # fmt: skip
    if not sequences or topic.name == "odometry":
        return good[: int(rng.integers(len(good)))]
    key = sequences[int(rng.integers(len(sequences)))]
    value = message[key]
    message[key] = (value[:-1], value[:0], value + value)[int(rng.integers(3))]
    try:
        return _encoded(topic, message)
    except Exception:  # an array of fixed size
        return good[: int(rng.integers(len(good)))]


def _truncated(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    return good[: int(rng.integers(len(good)))]


def _huge_length(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    """A length of four thousand million somewhere, which the bytes do not have."""
    data = bytearray(good)
    at = 4 * int(rng.integers(1, len(data) // 4))
    length = (0xFFFFFFFF, 0x7FFFFFFF, 0x10000000, 10**6)[int(rng.integers(4))]
    struct.pack_into("<I", data, at, length)
    return bytes(data)


def _trailing(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    return good + rng.bytes(int(rng.integers(1, 64)))


def _big_endian(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    return b"\x00\x00" + good[2:]


def _empty(rng: Rng, topic: Topic, good: bytes, names: tuple[str, ...]) -> bytes:
    return good[: int(rng.integers(0, 5))]


_WAYS: tuple[Callable[..., bytes], ...] = (
    _wrong_number, _wrong_number, _every_number, _wrong_stamp, _wrong_stamp, _wrong_text,
    _wrong_size, _truncated, _huge_length, _trailing, _big_endian, _empty,
)  # fmt: skip
