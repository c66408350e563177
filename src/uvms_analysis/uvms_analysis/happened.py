"""The events of a run: what the plant says on /diagnostics that happened to it."""

from collections.abc import Iterator
from typing import Any

from uvms_analysis.log.read import RunLog
from uvms_core import topics

EVENT, AT = "event_", "event_at_s"
"""What the names of the values begin with, a number follows; and when it was, s."""


def events_of(log: RunLog) -> Iterator[dict[str, Any]]:
    """Time and text of each event that began or ended, in order; raises LogError."""
    statuses = log.statuses(topics.PLANT) if log.has(topics.DIAGNOSTICS) else []
    for status in statuses:
        for name, text in status.values.items():
            if name.startswith(EVENT) and name != AT:
                yield {"at_s": status.number(AT), "text": str(text)}
