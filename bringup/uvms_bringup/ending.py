"""What is gathered during a run for the record of its end."""

from dataclasses import dataclass, field
from typing import Any

from uvms_analysis.log.run_end import RunEnd


@dataclass
class Ending:
    """As `RunEnd`, while the run goes on."""

    goal: str = "none"
    sent: dict[str, int] = field(default_factory=dict)
    lost: dict[str, int] = field(default_factory=dict)
    foreign: tuple[str, ...] = ()
    incidents: list[str] = field(default_factory=list)
    goals: tuple[dict[str, Any], ...] = ()

    def record(self, asked_s: float, stopped_by: str) -> RunEnd:
        """The record for the log.

        Args:
            asked_s: simulated time that the run was asked for, s.
            stopped_by: as in `RunEnd`.
        """
        return RunEnd(
            asked_s,
            stopped_by,
            self.goal,
            self.sent,
            self.lost,
            self.foreign,
            tuple(self.incidents),
            self.goals,
        )
