"""What the nodes count on /diagnostics: inputs refused, safe outputs, resets; and their bounds."""

from collections.abc import Iterator, Mapping

from uvms_analysis.log.read import RunLog
from uvms_core import topics
from uvms_core.diagnostics import STEPS_BEYOND_LIMITS

REFUSED, HELD, UNSAFE, RESETS = "refused", "held", "unsafe_outputs", "resets"
COUNTED = (
    REFUSED,
    HELD,
    UNSAFE,
    RESETS,
    "unreadable",
    "implausible",
    "jumps_taken",
    "ahead",
    "back",
    "duplicates",
    "late",
    "abandoned_ticks",
    "lockstep_timeouts",
    STEPS_BEYOND_LIMITS,
)
"""Values of a node's diagnostics that only rise; a node that is started again begins at zero."""

REFUSED_SHARE = 0.05
"""Inputs that a node refused, or replaced by their last good value, for each control tick, up to
which the loop is still the one that was meant: it loses phase as at 19 instead of 20 Hz."""

Counters = dict[str, dict[str, int]]


def node_counters(log: RunLog) -> Counters:
    """The final counts of every node, by its name; those of all its starts together.

    Raises:
        LogError: /diagnostics cannot be read.
    """
    totals: Counters = {}
    newest: Counters = {}
    statuses = log.signals(topics.DIAGNOSTICS) if log.has(topics.DIAGNOSTICS) else []
    for status in statuses:
        role = status.name.split(":")[0].strip().rsplit("/", 1)[-1]
        total, last = totals.setdefault(role, {}), newest.setdefault(role, {})
        for key in COUNTED:
            value = status.number(key)
            if not 0.0 <= value < 2.0**63:  # neither NaN nor a number of a broken message
                continue
            count, before = int(value), last.get(key, 0)
            total[key] = total.get(key, 0) + (count - before if count >= before else count)
            last[key] = count
    return {role: counts for role, counts in totals.items() if counts}


def invalid_outputs(counters: Mapping[str, Mapping[str, int]]) -> Iterator[str]:
    """Which parts made outputs that had to be replaced by safe ones."""
    for role, counts in counters.items():
        if count := counts.get(UNSAFE, 0):
            yield f"{role}: its output was invalid in {count} ticks, and replaced by a safe one"


def lost_inputs(counters: Mapping[str, Mapping[str, int]], ticks: int) -> Iterator[str]:
    """Which nodes were thrown back in time, or did not use too many of their inputs.

    Args:
        ticks: control ticks of the run.
    """
    for role, counts in counters.items():
        if count := counts.get(RESETS, 0):
            yield f"{role} restarted {count} times, since time had jumped"
        for key, word in ((REFUSED, "refused"), (HELD, "replaced")):
            count = counts.get(key, 0)
            if count > REFUSED_SHARE * ticks:
                bound = f"(bound {REFUSED_SHARE:.0%})"
                yield f"{role} {word} {count} inputs in {ticks} ticks {bound}"
