"""`make field`: runs the trial field and writes its table into docs/trial-field.md.

`python -m uvms_bringup.field [--campaign NAME] [--select PATTERN] [--workers N] [--output DIR]
[--page FILE]`, or with `--from DIR` only the table, of a campaign that has run. `control_study`
has its table in docs/control.md; any other campaign has none unless `--page` names one. The exit
code is 0 whether cases pass or not: the field measures, and its table shows what does not pass.
"""

import json
import os
import sys
from argparse import ArgumentParser, Namespace
from collections.abc import Sequence
from datetime import date
from pathlib import Path
from typing import Any

from uvms_bringup.campaign.field_page import lines_of, table, write_page
from uvms_bringup.campaign.file import load_campaign
from uvms_bringup.campaign.results import SUMMARY_FILE
from uvms_bringup.campaign.runner import CampaignRunner
from uvms_bringup.errors import CampaignError
from uvms_bringup.folder import new_folder
from uvms_bringup.session import git_revision
from uvms_core.errors import UvmsError

CAMPAIGN = "trial_field"
PAGES = {CAMPAIGN: Path("docs/trial-field.md"), "control_study": Path("docs/control.md")}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the field, or take its results, and write the page; 2 where that is not possible."""
    options = _parser().parse_args(arguments)
    if options.page is None:
        options.page = str(PAGES.get(options.campaign, ""))
    try:
        summary = _taken(Path(options.taken)) if options.taken else _run(options)
        if summary is None:
            return 1
        if options.page:
            content = table(summary, _command(options), git_revision(), date.today())
            write_page(Path(options.page), content)
            print(f"table: {options.page}")
    except (UvmsError, OSError) as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    for line in lines_of(summary):
        print(f"does not pass  {line}")
    return 0


def _parser() -> ArgumentParser:
    parser = ArgumentParser(prog="make field", description="Run the trial field.")
    add = parser.add_argument
    add("--campaign", default=CAMPAIGN, metavar="CAMPAIGN", help="default: %(default)s")
    add("--select", default="*", metavar="PATTERN", help="cases whose name fits; no page then")
    add("--workers", type=int, default=len(os.sched_getaffinity(0)), metavar="N")
    add("--output", metavar="DIR", help="folder of the results (default: runs/CAMPAIGN-TIME)")
    add("--resume", action="store_true", help="go on with the field in --output DIR")
    add("--from", dest="taken", metavar="DIR", help="results that are there: run nothing")
    add("--page", metavar="FILE", help="page that gets the table (default: the campaign's own)")
    return parser


def _command(options: Namespace) -> str:
    """The command that makes the page again."""
    chosen = "" if options.campaign == CAMPAIGN else f' ARGS="--campaign {options.campaign}"'
    return f"make field{chosen}"


def _run(options: Namespace) -> dict[str, Any] | None:
    """Run the campaign; its summary, None where a signal ended it."""
    campaign = load_campaign(options.campaign)
    folder = Path(options.output or new_folder(campaign.campaign)).resolve()
    if options.select != "*":
        options.page = ""  # half a table would look like a whole one
    print(f"{campaign.campaign}: {campaign.description}".rstrip(": "), flush=True)
    runner = CampaignRunner(
        options.workers,
        resume=options.resume,
        select=options.select,
        say=lambda line: print(line, flush=True),
    )
    results, stopped = runner.run(campaign, folder, "make field")
    if stopped is not None:
        print(
            f'{stopped}; go on with make field ARGS="--resume --output {folder}"', file=sys.stderr
        )
        return None
    return results.summary()


def _taken(folder: Path) -> dict[str, Any]:
    path = folder / SUMMARY_FILE
    try:
        summary: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as fault:
        raise CampaignError(f"--from {folder}: holds no results of a campaign: {fault}") from fault
    return summary


if __name__ == "__main__":
    raise SystemExit(main())
