"""The numbers in the messages of one topic: least, mean, most and last of each field."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from uvms_analysis.log.definition import UNDECODABLE
from uvms_analysis.log.read import RunLog
from uvms_analysis.overview.columns import in_columns

HEAD = ("field", "least", "mean", "most", "last")


@dataclass(frozen=True)
class ValueRow:
    """One number of a message, over all messages of a log that have it."""

    field: str
    least: float
    mean: float
    most: float
    last: float


def value_rows(log: RunLog, topic: str) -> list[ValueRow]:
    """A row for each number in the messages of a topic, in the order of its definition.

    Args:
        log: any log with definitions of ROS 2 messages.
        topic: full name, or the name relative to the log's namespace.

    Raises:
        LogError: the log has no such topic, or its definition cannot be read.
    """
    name = topic if topic in log.topics or topic.startswith("/") else _full(log, topic)
    decode = log.codec(name).decode
    found: dict[str, list[float]] = {}
    for _, _, data in log.raw([name]):
        try:
            message = decode(data)
        except UNDECODABLE:
            continue
        for field, value in _numbers(message, ""):
            found.setdefault(field, []).append(value)
    return [_row(field, np.array(values)) for field, values in found.items()]


def values_text(rows: Sequence[ValueRow]) -> str:
    """The rows as a table."""
    lines: list[tuple[str, ...]] = [HEAD]
    for row in rows:
        numbers = (row.least, row.mean, row.most, row.last)
        lines.append((row.field, *(f"{number:.6g}" for number in numbers)))
    return in_columns(lines, right=range(1, len(HEAD)))


def _full(log: RunLog, topic: str) -> str:
    return "/" + "/".join(part for part in (log.namespace, topic) if part)


def _row(field: str, values: np.ndarray) -> ValueRow:
    return ValueRow(
        field, float(values.min()), float(values.mean()), float(values.max()), float(values[-1])
    )


def _numbers(value: Any, name: str) -> Iterator[tuple[str, float]]:
    """Names and values of the numbers in a message."""
    if is_dataclass(value):
        for each in fields(value):
            inner = getattr(value, each.name)
            yield from _numbers(inner, f"{name}.{each.name}" if name else each.name)
    elif isinstance(value, bool | int | float | np.number):
        yield name, float(value)
    elif isinstance(value, list | tuple | np.ndarray):
        for index, inner in enumerate(value):
            yield from _numbers(inner, f"{name}[{index}]")
