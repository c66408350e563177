"""Which commands the plant used: none too late, none left unused, and never its safe state."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uvms_analysis.check.contents import Contents
from uvms_analysis.check.expected import Rhythms
from uvms_analysis.check.finding import COMMANDS, Finding
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import Series
from uvms_core import topics
from uvms_core.checks import MAX_AGE_S
from uvms_core.signals import NANOSECONDS
from uvms_core.topic import Topic

LATE_TICKS = 1.5
"""Control periods: a command that the plant still uses at this age is late. The controllers are
laid out for a delay of one period."""

LATE_SHARE = 0.05
"""In real time, the share of ticks under late commands, and of commands that were never used, up
to which the run is still the one that was meant."""

PATIENCE = "stale_s"
"""Key in the plant's diagnostics: how long it waits for a command in real time, s. It may hold its
safe state so long at the start. A plant that does not say it counts as one with the default."""


@dataclass(frozen=True)
class Used:
    """What the plant did with the commands of one topic."""

    topic: str
    ticks: int
    safe: NDArray[np.int64]  # stamps of the ticks in safe state, ns
    ages: NDArray[np.float64]  # of the used commands, in control periods
    sent: int
    unused: int


def check_commands(contents: Contents, rhythms: Rhythms | None) -> Iterator[Finding]:
    """Safe states, late and unused commands, for thrusters and joints."""
    if rhythms is None:
        return
    for used in used_commands(contents, rhythms):
        yield from _safe(contents, used)
        yield from _late(contents, used)
        yield from _unused(contents, used)


def used_commands(contents: Contents, rhythms: Rhythms) -> list[Used]:
    """What the plant did with the commands; empty where the log does not say it."""
    log = contents.log
    if not log.has(topics.APPLIED_THRUST):
        return []
    try:
        applied = log.series(topics.APPLIED_THRUST)
    except LogError:
        return []
    pairs = (
        (topics.THRUSTER_COMMAND, applied.thruster_safe, applied.thruster_command_stamp),
        (topics.JOINT_COMMAND, applied.joint_safe, applied.joint_command_stamp),
    )
    return [_used(contents, rhythms.period, applied, *pair) for pair in pairs]


def _used(
    contents: Contents,
    period: int,
    applied: Series,
    topic: Topic,
    safe: NDArray[np.bool_],
    command: NDArray[np.int64],
) -> Used:
    later = applied.stamps > 0  # at 0 nothing has been applied yet
    stamps, safe, command = applied.stamps[later], safe[later].astype(bool), command[later]
    ages = (stamps - period - command)[~safe] / period
    found = contents.of(topic)
    sent = np.unique(found.times) if found is not None else np.empty(0, dtype=np.int64)
    end = stamps[-1] - period if len(stamps) else -1  # later commands had no tick to be used in
    due = sent[sent <= end]
    unused = int(np.sum(~np.isin(due, command[~safe])))
    return Used(contents.log.full_name(topic), len(stamps), stamps[safe], ages, len(due), unused)


def _safe(contents: Contents, used: Used) -> Iterator[Finding]:
    start = 0.0 if contents.is_lockstep else _patience_s(contents) * NANOSECONDS
    after = used.safe[used.safe > start + _unknown_until(contents)]
    if len(after):
        text = (
            f"the plant held its safe state in {len(after)} of {used.ticks} ticks, first at"
            f" {after[0] / NANOSECONDS:.3f} s: no command came in time"
        )
        yield Finding(COMMANDS, text, used.topic)


def _unknown_until(contents: Contents) -> int:
    """Stamp up to which navigation did not know from the start where the vehicle is, ns.

    In real time there are no torques until then.
    """
    log = contents.log
    if contents.is_lockstep or not log.has(topics.ODOMETRY_GAPS):
        return 0
    try:
        known = log.signals(topics.ODOMETRY) if log.has(topics.ODOMETRY) else []
        unknown = log.signals(topics.ODOMETRY_GAPS)
    except LogError:
        return 0
    first = known[0].stamp if known else math.inf
    return max((each.stamp for each in unknown if each.stamp < first), default=0)


def _patience_s(contents: Contents) -> float:
    try:
        said = [status.number(PATIENCE) for status in contents.log.statuses(topics.PLANT)]
    except LogError:  # a finding of its own: `check.content`
        said = []
    return max((value for value in said if math.isfinite(value)), default=MAX_AGE_S)


def _late(contents: Contents, used: Used) -> Iterator[Finding]:
    late = int(np.sum(used.ages > LATE_TICKS))
    early = int(np.sum(used.ages < 0.0))
    if early:
        yield Finding(COMMANDS, f"{early} commands were used before their stamp", used.topic)
    if late:
        text = (
            f"{late} of {used.ticks} ticks were under commands that were late, by up to"
            f" {float(np.max(used.ages)):.0f} control periods"
        )
        yield Finding(COMMANDS, text, used.topic, _serious(contents, late, used.ticks))


def _unused(contents: Contents, used: Used) -> Iterator[Finding]:
    if used.unused:
        text = f"{used.unused} of {used.sent} commands were never used"
        serious = _serious(contents, used.unused, used.sent)
        yield Finding(COMMANDS, text, used.topic, serious)


def _serious(contents: Contents, count: int, of: int) -> bool:
    return contents.is_lockstep or count > LATE_SHARE * of
