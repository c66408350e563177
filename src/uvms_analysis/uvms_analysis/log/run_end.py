"""What whoever conducted a run knows about its end and the messages do not show.

The last metadata record of a log. A log without it was cut off: its writer was killed.
"""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from uvms_analysis.errors import LogError

NAME = "run_end"
"""Name of the metadata record."""

GOALS = ("none", "running", "succeeded", "aborted", "canceled", "rejected")


@dataclass(frozen=True)
class RunEnd:
    """How a run ended.

    Args:
        asked_s: simulated time that the run was asked for, s.
        stopped_by: empty where the run reached its end by itself; else `SIGINT`, `SIGTERM`, or the
            text of the error that ended it.
        goal: `none`, `running`, `succeeded`, `aborted`, `canceled` or `rejected`.
        sent: messages that should be in the log by what the nodes say they sent, by full topic
            name, whatever was received; those of before the run, and of nodes that died, are taken
            as they were received. Fewer in the log are lost, more come from somebody else. Empty
            where nobody counted.
        lost: of these, how many the recorder never got, by full topic name; without zeros.
        foreign: endpoints that did not belong to the run, in words; empty: there were none.
        incidents: what else happened, in words: a node that died and was started again, say.
        goals: of several goals in turn, or of one, what became of each: `kind` (path, joints or
            pose), `state` (as `goal`, or `waiting`), `message`, `began_s` and `ended_s`. Logs of
            before there were several have none.
    """

    asked_s: float
    stopped_by: str = ""
    goal: str = "none"
    sent: Mapping[str, int] = field(default_factory=dict)
    lost: Mapping[str, int] = field(default_factory=dict)
    foreign: tuple[str, ...] = ()
    incidents: tuple[str, ...] = ()
    goals: tuple[Mapping[str, Any], ...] = ()

    def to_metadata(self) -> dict[str, str]:
        """As texts, which is what a metadata record holds."""
        return {key: json.dumps(value) for key, value in asdict(self).items()}

    @classmethod
    def from_metadata(cls, record: Mapping[str, str]) -> "RunEnd":
        """From a metadata record.

        Raises:
            LogError: a field is missing or is not what it should be.
        """
        values: dict[str, Any] = {}
        for each in fields(cls):
            if each.name == "goals" and each.name not in record:
                continue
            try:
                values[each.name] = json.loads(record[each.name])
            except (KeyError, ValueError) as fault:
                raise LogError(f"metadata {NAME!r}: {each.name} is missing or damaged") from fault
        for name, is_right in _RIGHT.items():
            if name in values and not is_right(values[name]):
                raise LogError(f"metadata {NAME!r}: {name} is {values[name]!r}")
        for name in ("foreign", "incidents", "goals"):
            values[name] = tuple(values.get(name, ()))
        return cls(**values)


def _is_duration(value: Any) -> bool:
    number = isinstance(value, int | float) and not isinstance(value, bool)
    return number and math.isfinite(value) and value >= 0.0


def _is_counts(value: Any) -> bool:
    return isinstance(value, dict) and all(type(n) is int and n >= 0 for n in value.values())


def _are_goals(value: Any) -> bool:
    names = {"kind", "state", "message", "began_s", "ended_s"}
    return isinstance(value, list) and all(
        isinstance(one, dict) and names <= one.keys() for one in value
    )


def _is_texts(value: Any) -> bool:
    return isinstance(value, list) and all(isinstance(one, str) for one in value)


_RIGHT: dict[str, Callable[[Any], bool]] = {
    "asked_s": _is_duration,
    "stopped_by": lambda value: isinstance(value, str),
    "goal": lambda value: value in GOALS,
    "sent": _is_counts,
    "lost": _is_counts,
    "foreign": _is_texts,
    "incidents": _is_texts,
    "goals": _are_goals,
}
"""What the values of a record must be; it may have been damaged or written by hand."""
