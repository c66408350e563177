"""All checks of a log, and what they come to."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_analysis.check.commands import check_commands, used_commands
from uvms_analysis.check.content import check_content
from uvms_analysis.check.contents import Contents
from uvms_analysis.check.counts import check_counts, expected_counts
from uvms_analysis.check.end import check_end
from uvms_analysis.check.expected import Rhythms, rhythms
from uvms_analysis.check.file import check_file
from uvms_analysis.check.finding import END, Finding
from uvms_analysis.check.order import check_order
from uvms_analysis.check.span import check_span
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core.signals import NANOSECONDS

COMPLETE, NOT_COMPLETE = "complete", "not complete"


@dataclass(frozen=True)
class TopicRow:
    """A topic in figures; `expected` is None where nothing says how many there should be."""

    topic: str
    expected: int | None
    received: int
    first_s: float | None
    last_s: float | None
    rejected: int
    findings: int


@dataclass(frozen=True)
class Check:
    """What a log has and lacks."""

    path: Path
    rows: tuple[TopicRow, ...]
    findings: tuple[Finding, ...]
    asked_s: float | None
    reached_s: float
    oldest_command_ticks: float | None  # age of the oldest command that the plant used

    @property
    def faults(self) -> list[Finding]:
        """The serious findings."""
        return [finding for finding in self.findings if finding.serious]

    @property
    def notes(self) -> list[Finding]:
        """The others."""
        return [finding for finding in self.findings if not finding.serious]

    @property
    def complete(self) -> bool:
        """Whether there is no serious finding."""
        return not self.faults

    @property
    def verdict(self) -> str:
        """`complete` or `not complete`."""
        return COMPLETE if self.complete else NOT_COMPLETE

    def summary(self) -> dict[str, Any]:
        """For `summary.json`: verdict, reasons, notes, and the topics that have wrong counts."""
        wrong = {
            row.topic: {"expected": row.expected, "received": row.received}
            for row in self.rows
            if row.expected is not None and row.expected != row.received
        }
        return {
            "verdict": self.verdict,
            "faults": list(map(str, self.faults)),
            "notes": list(map(str, self.notes)),
            "counts": wrong,
        }

    def to_json(self) -> dict[str, Any]:
        """Everything as plain data."""
        return {
            "log": str(self.path),
            "verdict": self.verdict,
            "asked_s": self.asked_s,
            "reached_s": self.reached_s,
            "oldest_command_ticks": self.oldest_command_ticks,
            "findings": [vars(finding) for finding in self.findings],
            "topics": [vars(row) for row in self.rows],
        }


def check_log(log: str | Path | RunLog) -> Check:
    """Check a log.

    Raises:
        LogError: the file cannot be read, or it is not an MCAP file.
    """
    contents = Contents(log if isinstance(log, RunLog) else RunLog.open(log))
    unusable: tuple[Finding, ...] = ()
    try:
        rhythm = rhythms(contents)
    except LogError as fault:
        rhythm, unusable = None, (Finding(END, str(fault)),)
    findings = (
        *unusable,
        *check_file(contents),
        *check_end(contents),
        *check_span(contents, rhythm),
        *check_counts(contents, rhythm),
        *check_order(contents, rhythm),
        *check_content(contents),
        *check_commands(contents, rhythm),
    )
    end = contents.end
    return Check(
        contents.log.path,
        _rows(contents, rhythm, findings),
        findings,
        None if end is None else end.asked_s,
        contents.reached_s,
        _oldest(contents, rhythm),
    )


def _oldest(contents: Contents, rhythm: Rhythms | None) -> float | None:
    used = used_commands(contents, rhythm) if rhythm is not None else []
    return max((float(one.ages.max()) for one in used if len(one.ages)), default=None)


def _rows(
    contents: Contents, rhythm: Rhythms | None, findings: Sequence[Finding]
) -> tuple[TopicRow, ...]:
    end = contents.end
    expected = expected_counts(contents, rhythm) | dict(end.sent if end is not None else {})
    names = sorted({*contents.topics, *expected})
    return tuple(_row(contents, name, expected.get(name), findings) for name in names)


def _row(
    contents: Contents, name: str, expected: int | None, findings: Sequence[Finding]
) -> TopicRow:
    found = contents.topics.get(name)
    serious = sum(finding.serious and finding.topic == name for finding in findings)
    if found is None or not found.stamps:
        return TopicRow(name, expected, 0, None, None, 0, serious)
    first, last = (float(t) / NANOSECONDS for t in (found.times.min(), found.times.max()))
    count = len(found.stamps)
    return TopicRow(name, expected, count, first, last, len(found.rejected), serious)
