"""How often each topic of a log has a message, and for how long it had none."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from uvms_analysis.log.read import RunLog
from uvms_analysis.overview.columns import in_columns
from uvms_core.signals import NANOSECONDS

HEAD = ("topic", "type", "messages", "rate Hz", "first s", "last s", "longest gap s")


@dataclass(frozen=True)
class TopicRow:
    """One topic of a log; None where it has too few messages to tell.

    Args:
        topic: full name.
        type: of its messages.
        messages: how many there are.
        first_s: log time of the first, s.
        last_s: log time of the last, s.
        rate_hz: mean rate between them, Hz.
        longest_gap_s: longest time between two messages, s.
    """

    topic: str
    type: str
    messages: int
    first_s: float | None
    last_s: float | None
    rate_hz: float | None
    longest_gap_s: float | None


def topic_rows(log: RunLog) -> list[TopicRow]:
    """A row for each topic, by name.

    Raises:
        LogError: the log cannot be read.
    """
    stamps: dict[str, list[int]] = {name: [] for name in log.topics}
    for name, entry in log.entries():
        stamps[name].append(entry.stamp)
    return [_row(name, log.topics[name], stamps[name]) for name in sorted(stamps)]


def rows_text(rows: Sequence[TopicRow]) -> str:
    """The rows as a table."""
    lines = [HEAD, *(_words(row) for row in rows)]
    return in_columns(lines, right=range(2, len(HEAD)))


def _row(name: str, kind: str, stamps: Sequence[int]) -> TopicRow:
    times = np.sort(np.array(stamps, dtype=np.int64)) / NANOSECONDS
    if times.size == 0:
        return TopicRow(name, kind, 0, None, None, None, None)
    span = float(times[-1] - times[0])
    return TopicRow(
        name,
        kind,
        times.size,
        float(times[0]),
        float(times[-1]),
        (times.size - 1) / span if span > 0.0 else None,
        float(np.diff(times).max()) if times.size > 1 else None,
    )


def _words(row: TopicRow) -> tuple[str, ...]:
    numbers = (row.rate_hz, row.first_s, row.last_s, row.longest_gap_s)
    written = ("" if number is None else f"{number:.6g}" for number in numbers)
    return row.topic, row.type, str(row.messages), *written
