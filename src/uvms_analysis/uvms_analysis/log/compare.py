"""Differences between two logs, topic by topic."""

from collections.abc import Sequence
from dataclasses import dataclass, fields, is_dataclass
from typing import Any

import numpy as np

from uvms_analysis.log.read import RunLog
from uvms_core.topics import Topic


@dataclass(frozen=True)
class Difference:
    """Message counts of a topic in both logs, and the greatest absolute difference in them."""

    topic: str
    recorded: int
    replayed: int
    common: int  # messages of the same stamp in both
    greatest: float  # nan where nothing can be compared


def compare(recorded: RunLog, replayed: RunLog, topics: Sequence[Topic]) -> list[Difference]:
    """Differences of these topics; messages are matched by their stamps."""
    return [_compare(recorded, replayed, topic) for topic in topics]


def _compare(recorded: RunLog, replayed: RunLog, topic: Topic) -> Difference:
    one, two = (log.signals(topic) if log.has(topic) else [] for log in (recorded, replayed))
    by_stamp = {_stamp(signal): signal for signal in two}
    pairs = [(a, by_stamp[_stamp(a)]) for a in one if _stamp(a) in by_stamp]
    greatest = max((_distance(a, b) for a, b in pairs), default=float("nan"))
    return Difference(topic.name, len(one), len(two), len(pairs), greatest)


def _stamp(signal: Any) -> int:
    return signal if isinstance(signal, int) else signal.stamp


def _distance(one: Any, two: Any) -> float:
    """Greatest absolute difference between two signals; infinite where their shapes differ."""
    if not is_dataclass(one):
        return float(one != two)
    pairs = ((getattr(one, field.name), getattr(two, field.name)) for field in fields(one))
    return max(_difference(a, b) for a, b in pairs)


def _difference(one: Any, two: Any) -> float:
    if one is None or two is None:
        return 0.0 if one is two else float("inf")
    if is_dataclass(one) and is_dataclass(two):  # a part of a signal
        return _distance(one, two)
    if isinstance(one, str):  # what a sensor has locked on
        return 0.0 if one == two else float("inf")
    if isinstance(one, tuple) and any(isinstance(each, str) for each in one):  # names
        return 0.0 if one == two else float("inf")
    a, b = np.asarray(one, dtype=float), np.asarray(two, dtype=float)
    if a.shape != b.shape:
        return float("inf")
    if not a.size:
        return 0.0
    both_unknown = np.isnan(a) & np.isnan(b)  # a GPS without a fix
    return float(np.max(np.where(both_unknown, 0.0, np.abs(a - b))))


def table(differences: Sequence[Difference]) -> str:
    """The differences as lines of text."""
    head = f"{'topic':28s} {'recorded':>9s} {'replayed':>9s} {'common':>9s}  greatest difference"
    rows = (
        f"{d.topic:28s} {d.recorded:9d} {d.replayed:9d} {d.common:9d}  {d.greatest:.3g}"
        for d in differences
    )
    return "\n".join([head, *rows])
