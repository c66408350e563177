"""What whoever conducted a run knows about its end and the messages do not show.

The last metadata record of a log. A log without it was cut off: its writer was killed.
"""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from uvms_analysis.errors import LogError

NAME = "run_end"
"""Name of the metadata record."""


@dataclass(frozen=True)
class RunEnd:
    """How a run ended.

    Args:
        asked_s: simulated time that the run was asked for, s.
        stopped_by: empty where the run reached its end by itself; else `SIGINT`, `SIGTERM`, or the
            text of the error that ended it.
        goal: `none`, `running`, `succeeded`, `aborted`, `canceled` or `rejected`.
        sent: messages that the nodes say they sent, by full topic name; empty where nobody counted.
        lost: of these, how many the recorder never got, by full topic name; without zeros.
        foreign: endpoints that did not belong to the run, in words; empty: there were none.
        incidents: what else happened, in words: a node that died and was started again, say.
    """

    asked_s: float
    stopped_by: str = ""
    goal: str = "none"
    sent: Mapping[str, int] = field(default_factory=dict)
    lost: Mapping[str, int] = field(default_factory=dict)
    foreign: tuple[str, ...] = ()
    incidents: tuple[str, ...] = ()

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
            try:
                values[each.name] = json.loads(record[each.name])
            except (KeyError, ValueError) as fault:
                raise LogError(f"metadata {NAME!r}: {each.name} is missing or damaged") from fault
        for name in ("foreign", "incidents"):
            values[name] = tuple(values[name])
        return cls(**values)
