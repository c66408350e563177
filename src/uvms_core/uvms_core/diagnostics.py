"""What a node says about itself on /diagnostics."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

OK, WARN, ERROR, STALE = range(4)

GOALS_ACCEPTED, PAUSES = "goals_accepted", "pauses"
"""Values of the planner and of the plant: what was asked of them, by whomever."""

STEPS_BEYOND_LIMITS = "steps_beyond_limits"
"""Value of the planner: steps that it planned beyond its own limits."""

MANIPULABILITY = "manipulability"
"""Value of the planner: that of the arm at the end of a step, as a share of the arm's best."""


class Trouble(NamedTuple):
    """Why what a part puts out cannot be relied on: how bad it is, and what it is in words.

    It is reported as soon as it changes, so that its text has no numbers that change all the time.
    """

    level: int  # WARN or ERROR
    text: str


def together(*said: tuple[int, str]) -> tuple[int, str]:
    """The worst level of several, and the texts of all that are not OK; the first where all are."""
    bad = [each for each in said if each[0] != OK]
    if not bad:
        return said[0]
    return max(level for level, _ in bad), "; ".join(text for _, text in bad)


@dataclass(frozen=True)
class Status:
    """State of one node at a stamp (ns); values are numbers or texts by key (`step_ms`, ...)."""

    stamp: int
    name: str
    level: int = OK
    message: str = "ok"
    values: Mapping[str, float | int | bool | str] = field(default_factory=dict)
    run_id: str = ""  # of the run that the node belongs to, "" where it knows of none

    def number(self, key: str) -> float:
        """A value as a number; NaN if the status has no such number."""
        try:
            return float(self.values[key])
        except (KeyError, ValueError):
            return float("nan")
