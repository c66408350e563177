"""The results of a campaign in its folder: table, statistics and page."""

import json
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.file import Campaign
from uvms_bringup.campaign.plan import Variant
from uvms_bringup.campaign.row import MISSING_LOG, OF_MACHINE, Row
from uvms_bringup.campaign.statistics import statistics, wilson
from uvms_bringup.campaign.table import TABLE_FILE, write_table
from uvms_bringup.errors import CampaignError

SUMMARY_FILE = "summary.json"
PAGE_FILE = "index.html"


@dataclass(frozen=True)
class Results:
    """The rows of a campaign, complete or not.

    Args:
        variants: all that the campaign has, in its order.
        computed: rows by case and seed, in any order.
    """

    campaign: Campaign
    variants: Sequence[Variant]
    folder: Path
    computed: Mapping[tuple[str, int], Row]

    @property
    def rows(self) -> list[Row]:
        """The rows in the order of the campaign, whatever the order in which they ended."""
        keys = ((one.case, seed) for one in self.variants for seed in one.seeds)
        return [self.computed[key] for key in keys if key in self.computed]

    @property
    def judged(self) -> list[Row]:
        """The rows that count: those of the cases, not of baselines."""
        return [row for row in self.rows if not row["baseline_of"]]

    @property
    def passed(self) -> int:
        """Rows that count and kept all that is required."""
        return sum(row["passed"] for row in self.judged)

    @property
    def planned(self) -> int:
        """Rows that will count when all runs are made."""
        return sum(len(one.seeds) for one in self.variants if not one.baseline_of)

    def notes(self) -> list[str]:
        """What the machine did not do: runs that it could not make, and logs not written."""
        notes = []
        rows = [row for row in self.rows if row.get(OF_MACHINE)]
        if rows:
            notes.append(
                f"{len(rows)} runs could not be made because of the machine"
                f" ({rows[0]['reasons'][0]}); mend the cause, and make them with --resume"
                f" --output {self.folder}"
            )
        rows = [row for row in self.rows if row.get(MISSING_LOG)]
        if rows:
            first = rows[0]
            notes.append(
                f"{len(rows)} logs could not be written ({first[MISSING_LOG]}); the results are"
                f" whole: make a log with uvms simulate --again {self.folder} '{first['case']}'"
                f" {first['seed']}"
            )
        return notes

    def summary(self) -> dict[str, Any]:
        """The content of `summary.json`."""
        started = {row["case"] for row in self.rows}
        shown = [one for one in self.variants if started & {one.case, one.baseline_of}]
        return {
            "campaign": self.campaign.campaign,
            "description": self.campaign.description,
            "planned": self.planned,
            "runs": len(self.judged),
            "passed": self.passed,
            "wilson_95": list(wilson(self.passed, len(self.judged))),
            "cases": statistics(_with_their_cases(self.variants, shown), self.rows),
        }

    def write(self) -> None:
        """Write table, statistics and page; nothing where there is no row yet.

        Raises:
            CampaignError: a file cannot be written.
        """
        if not self.rows:
            return
        from uvms_bringup.campaign.page import write_page  # draws, which takes a while to import

        summary = self.summary()
        try:
            write_table(self.folder / TABLE_FILE, self.rows)
        except OSError as fault:
            raise CampaignError(
                f"{self.folder / TABLE_FILE}: cannot be written: {fault.strerror or fault}; the"
                f" rows are kept: mend the cause, and write it with --resume --output {self.folder}"
            ) from fault
        write_text(self.folder / SUMMARY_FILE, f"{json.dumps(summary, indent=2)}\n")
        write_page(self.folder / PAGE_FILE, summary, self.rows)

    def draw(self, file: str) -> None:
        """Draw the distributions of all required fields to an image file.

        Raises:
            CampaignError: the file cannot be written.
        """
        from uvms_analysis.report import style
        from uvms_bringup.campaign.figures import picture

        cases = self.summary()["cases"]
        fields = list(dict.fromkeys(name for case in cases.values() for name in case["fields"]))
        low, high = wilson(self.passed, len(self.judged))
        title = (
            f"{self.campaign.campaign}: {self.passed} of {len(self.judged)} runs passed"
            f" ({100 * low:.0f} to {100 * high:.0f} %)"
        )
        try:
            with style.settings():
                picture(title, fields, cases, self.rows).savefig(file)
        except (OSError, ValueError) as fault:
            raise CampaignError(f"--picture {file}: cannot be written: {fault}") from fault


def check_picture(file: str) -> None:
    """Find out whether `Results.draw` can write this file, before anything runs.

    Raises:
        CampaignError: its ending is no kind of image, or its folder is not there.
    """
    from matplotlib.backend_bases import FigureCanvasBase

    kinds = sorted(FigureCanvasBase.get_supported_filetypes())
    path = Path(file)
    if path.suffix[1:].lower() not in kinds:
        raise CampaignError(
            f"--picture {file}: {path.suffix or 'no ending'!r} is no kind of image; choose from"
            f" {', '.join(f'.{kind}' for kind in kinds)}"
        )
    if not path.parent.is_dir():
        raise CampaignError(f"--picture {file}: there is no folder {path.parent}")
    if path.is_dir():
        raise CampaignError(f"--picture {file}: is a folder")


def write_text(path: Path, text: str) -> None:
    """Write a file in the place of the one before; all of it or nothing.

    Raises:
        CampaignError: it cannot be written.
    """
    partial = path.with_name(f".{path.name}.partial")
    try:
        partial.write_text(text, encoding="utf-8")
        partial.replace(path)
    except OSError as fault:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
        raise CampaignError(f"{path}: cannot be written: {fault.strerror}") from fault


def _with_their_cases(everything: Sequence[Variant], shown: Sequence[Variant]) -> list[Variant]:
    """Those to show, and the case of each baseline even where only the baseline has rows yet."""
    names = {one.case for one in shown} | {one.baseline_of for one in shown}
    return [one for one in everything if one.case in names]
