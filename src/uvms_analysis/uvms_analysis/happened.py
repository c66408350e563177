"""The events of a run: what the plant says on /diagnostics that happened to it, and the rest."""

from collections.abc import Iterator
from typing import Any

from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.diagnostics import Status

EVENT, AT = "event_", "event_at_s"
"""What the names of the values begin with, a number follows; and when it was, s."""


def events_of(log: RunLog) -> Iterator[dict[str, Any]]:
    """Time and text of each event that began or ended, in order; raises LogError."""
    statuses = log.statuses(topics.PLANT) if log.has(topics.DIAGNOSTICS) else []
    for status in statuses:
        yield from events_in(status)


def events_in(status: Status) -> Iterator[dict[str, Any]]:
    """Time and text of each event that one status of the plant tells of, in order."""
    for name, text in status.values.items():
        if name.startswith(EVENT) and name != AT:
            yield {"at_s": status.number(AT), "text": str(text)}


def not_reached(log: RunLog, end_s: float) -> list[dict[str, Any]]:
    """Events of the scenario that come after the end of the run, as it gives them."""
    events = log.configuration().get("events") or ()
    return [
        {name: value for name, value in event.items() if value is not None}
        for event in events
        if isinstance(event, dict) and float(event.get("at_s", 0.0)) > end_s
    ]
