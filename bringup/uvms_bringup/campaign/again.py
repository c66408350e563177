"""A row of a campaign made again alone, with its log, and compared with the row."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.journal import Journal
from uvms_bringup.campaign.plan import Run, find_run
from uvms_bringup.campaign.row import Row, row_of, without_timings
from uvms_bringup.campaign.runner import copied_campaign
from uvms_bringup.campaign.worker import session
from uvms_bringup.session import Session


@dataclass(frozen=True)
class Again:
    """A run of a campaign, and the row that it had there; None where it has not been made."""

    run: Run
    row: Row | None

    @classmethod
    def of(cls, folder: Path, case: str, seed: int) -> "Again":
        """The run of a row.

        Raises:
            CampaignError: the folder holds no campaign, or there is no such row; says what is.
        """
        run = find_run(copied_campaign(folder), case, seed)
        return cls(run, Journal(folder).rows.get(run.key))

    def session(self, output: str | None, command: str) -> Session:
        """The run, ready to be made.

        Raises:
            ScenarioError, RunError: as `prepare`.
        """
        return session(self.run, output, command)

    def differences(self, summary: Mapping[str, Any]) -> list[str]:
        """Fields that are not the row's, in words; empty where all are."""
        if self.row is None:
            return []
        old, new = without_timings(self.row), without_timings(row_of(self.run, summary))
        names = [*old, *(name for name in new if name not in old)]
        return [
            f"{name}: {old.get(name)} in the campaign, {new.get(name)} now"
            for name in names
            if old.get(name) != new.get(name)
        ]
