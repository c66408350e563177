"""A run as the report sees it: its log, its summary, and what follows from both."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.read import RunLog


@dataclass(frozen=True)
class ReportedRun:
    """One of the runs of a page.

    Args:
        name: short, to tell runs apart.
        log: of the run.
        summary: of the log.
    """

    name: str
    log: RunLog
    summary: Mapping[str, Any]

    @cached_property
    def truth(self) -> Analysis:
        """What really happened, as far as the log has the ground truth."""
        return Analysis(self.log)

    @cached_property
    def seen(self) -> Analysis:
        """What the loop itself could see: its `truth` is the estimate with the encoders."""
        return Analysis(self.log, estimated=True)

    @cached_property
    def title(self) -> str:
        """Scenario and seed, or what the file is called."""
        seed = self.summary.get("seed")
        return (
            f"{self.summary.get('scenario') or self.log.path.stem},"
            f" seed {'unknown' if seed is None else seed}"
        )
