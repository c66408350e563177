"""The outcome of a run: completed, or why not, from its log alone."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

from uvms_analysis import limits
from uvms_analysis.analysis import Analysis
from uvms_analysis.check import Check, check_log
from uvms_analysis.check.finding import END, FILE, Finding
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd

Word = Literal["completed", "given up", "aborted", "invalid"]
COMPLETED: Word = "completed"
GIVEN_UP: Word = "given up"
ABORTED: Word = "aborted"
INVALID: Word = "invalid"

EXIT_CODES: dict[str, int] = {COMPLETED: 0, GIVEN_UP: 1, ABORTED: 1, INVALID: 3}
"""Of `uvms run` and `uvms simulate`; 2 is bad input, 130 and 143 are SIGINT and SIGTERM."""


@dataclass(frozen=True)
class Outcome:
    """One of four words, and the reasons in words; no reasons where it is `completed`.

    completed: the task was done, within its limits, and the log proves it.
    given up: the run went to its end, but the task was not done, or a limit was not kept.
    aborted: the run ended before its end: a signal, a node that died, a plant that diverged.
    invalid: what was recorded proves nothing: messages are missing, commands came late, somebody
        else took part.
    """

    word: Word
    reasons: tuple[str, ...] = ()

    @property
    def completed(self) -> bool:
        """Whether the outcome is `completed`."""
        return self.word == COMPLETED


WORST_FIRST: tuple[Word, ...] = (INVALID, ABORTED, GIVEN_UP)
NO_RUN = "the log is not that of a run"


def judge(log: RunLog, check: Check | None = None) -> Outcome:
    """The outcome of the run in a log: the worst that was found, and all reasons, worst first.

    Args:
        check: of this log, where it has been made already.
    """
    check = check or check_log(log)
    reasons: dict[Word, list[str]] = {
        INVALID: _invalid(log, check),
        ABORTED: _aborted(log),
        GIVEN_UP: list(_given_up(log)),
    }
    for word in WORST_FIRST:
        if reasons[word]:
            return Outcome(word, tuple(text for each in WORST_FIRST for text in reasons[each]))
    return Outcome(COMPLETED)


def _invalid(log: RunLog, check: Check) -> list[str]:
    if not log.run:
        return [NO_RUN, *map(_reason, check.faults)]
    return [_reason(finding) for finding in check.faults]


def _reason(finding: Finding) -> str:
    subject = "the log: " if finding.kind in (FILE, END) and not finding.topic else ""
    return f"{subject}{finding}"


def _aborted(log: RunLog) -> list[str]:
    end = _end(log)
    return [f"stopped by {end.stopped_by}"] if end is not None and end.stopped_by else []


def _end(log: RunLog) -> RunEnd | None:
    try:
        return log.end
    except LogError:  # a finding of the check
        return None


def _given_up(log: RunLog) -> Iterator[str]:
    """Where the task was not done, or a limit was not kept; a measure that fails is no measure."""
    run = Analysis(log)
    yield from _goal(log, run)
    measures: tuple[Callable[[Analysis], str], ...] = (limits.arm,)
    if limits.is_controlled(log):
        measures = (limits.attitude, limits.saturation, limits.end_effector)
    for measure in measures:
        try:
            if text := measure(run):
                yield text
        except LogError:  # what is missing is a finding of the check
            continue


def _goal(log: RunLog, run: Analysis) -> Iterator[str]:
    end = _end(log)
    if end is None or end.goal in ("none", "succeeded"):
        return
    if end.goal != "running":
        yield f"the planner's goal was {end.goal}"
    elif limits.goal_end_s(run) < end.asked_s and not end.stopped_by:
        yield "the planner's goal was still running at the end"
