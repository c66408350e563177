"""The outcome of a run: completed, or why not, from its log alone."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from typing import Literal

from uvms_analysis import counters, limits
from uvms_analysis.analysis import Analysis
from uvms_analysis.check import Check, check_log
from uvms_analysis.check.finding import END, FILE, Finding
from uvms_analysis.errors import LogError, determine
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd
from uvms_core import topics

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


TRUTH, ESTIMATES = "ground truth", "estimates"


def judged_by(log: RunLog) -> str:
    """What the limits are judged by: estimates where the log has no true odometry at all.

    A plant that is not ours may have none to publish. Where ours did and it is missing, that is a
    fault of its own.
    """
    return TRUTH if log.counts.get(log.full_name(topics.TRUE_ODOMETRY)) else ESTIMATES


def judge(log: RunLog, check: Check | None = None, truth: Analysis | None = None) -> Outcome:
    """The outcome of the run in a log: the worst that was found, and all reasons, worst first.

    Args:
        check: of this log, where it has been made already.
        truth: analysis of this log by its true odometry, where there is one already.
    """
    check = check or check_log(log)
    if not log.run and _end(log) is None:
        return Outcome(INVALID, (NO_RUN, *map(_reason, check.faults)))
    estimated = judged_by(log) == ESTIMATES
    run = Analysis(log, estimated) if estimated or truth is None else truth
    broken, unknown = _limits(run)
    unsafe, inputs = _counted(log)
    aborted = _aborted(log)
    reasons: dict[Word, list[str]] = {
        # A run that was stopped may have ended before there was anything to judge.
        INVALID: [*map(_reason, check.faults), *inputs, *([] if aborted else unknown)],
        ABORTED: aborted,
        GIVEN_UP: [*_goal(log, run), *broken, *unsafe],
    }
    for word in WORST_FIRST:
        if reasons[word]:
            return Outcome(word, tuple(text for each in WORST_FIRST for text in reasons[each]))
    return Outcome(COMPLETED)


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


def _limits(run: Analysis) -> tuple[list[str], list[str]]:
    """Why limits were not kept, and why others cannot be judged."""
    measures: dict[str, Callable[[Analysis], str]] = {"joints": limits.arm}
    if limits.is_controlled(run.log):
        measures = {
            "attitude": limits.attitude,
            "thrusters": limits.saturation,
            "end effector": limits.end_effector,
            "vehicle": limits.vehicle,
        }
    broken, unknown = [], []
    for name, measure in measures.items():
        try:
            broken.append(determine(partial(measure, run)))
        except LogError as fault:
            unknown.append(f"its limits cannot be judged ({name}): {fault}")
    return list(filter(None, broken)), unknown


def _counted(log: RunLog) -> tuple[list[str], list[str]]:
    """What the nodes' counters say: invalid outputs of parts, and inputs that were lost."""
    try:
        counts = counters.node_counters(log)
    except LogError:  # a finding of the check: what is there under this name is something else
        return [], []
    if not counts:
        return [], [f"no node says on {topics.DIAGNOSTICS.name} what it has counted"]
    ticks = log.counts.get(log.full_name(topics.CLOCK), 0)
    return list(counters.invalid_outputs(counts)), list(counters.lost_inputs(counts, ticks))


def _goal(log: RunLog, run: Analysis) -> Iterator[str]:
    end = _end(log)
    if end is None or end.goal in ("none", "succeeded"):
        return
    done = sum(goal["state"] == "succeeded" for goal in end.goals)
    which = "the planner's goal"
    if len(end.goals) > 1:
        which = f"of {len(end.goals)} goals {done} succeeded, and then one"
    if end.goal != "running":
        yield f"{which} was {end.goal}"
    elif limits.goal_end_s(run) < end.asked_s and not end.stopped_by:
        yield f"{which} was still running at the end"
