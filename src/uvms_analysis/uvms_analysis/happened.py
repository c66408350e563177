"""The events of a run: what the plant says on /diagnostics that happened to it."""

from collections.abc import Iterator
from typing import Any

from uvms_analysis.log.read import RunLog
from uvms_core import topics

EVENT, AT = "event", "event_at_s"
"""Names of the values."""


def events_of(log: RunLog) -> Iterator[dict[str, Any]]:
    """Time and text of each event that began or ended, in order; raises LogError."""
    statuses = log.statuses(topics.PLANT) if log.has(topics.DIAGNOSTICS) else []
    for status in statuses:
        if EVENT in status.values:
            yield {"at_s": status.number(AT), "text": str(status.values[EVENT])}
