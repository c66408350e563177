"""The command `uvms campaign`: many runs of varied scenarios, judged by requirements."""

import sys
from argparse import ArgumentParser, ArgumentTypeError, Namespace
from typing import TYPE_CHECKING

from uvms_core.command import Command

if TYPE_CHECKING:
    from uvms_bringup.campaign.results import Results


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms campaign`."""
    from uvms_bringup.locate import known_campaigns

    add = parser.add_argument
    names = ", ".join(known_campaigns())
    add("campaign", metavar="CAMPAIGN", help=f"{names}, or a YAML file of your own")
    where = parser.add_mutually_exclusive_group()
    where.add_argument(
        "--workers",
        type=_count,
        metavar="N",
        help="processes on this machine (default: one for each core)",
    )
    where.add_argument(
        "--scheduler",
        default="",
        metavar="ADDRESS",
        help="use the workers of this dask scheduler (tcp://HOST:8786) instead",
    )
    add("--output", metavar="DIR", help="folder of the results (default: runs/CAMPAIGN-TIME)")
    add("--resume", action="store_true", help="go on with the campaign in --output DIR")
    add(
        "--select",
        default="*",
        metavar="PATTERN",
        help="only the cases whose name fits ('current*'), with their baselines",
    )
    add("--picture", metavar="FILE", help="draw the distributions to this file (png, svg, pdf)")
    add(
        "--logs",
        choices=("none", "failed", "all"),
        default="none",
        help="runs whose logs are kept, in DIR/logs (default: none)",
    )


def run(options: Namespace) -> int:
    """Run the campaign; 0: all runs kept what is required, 1: some did not."""
    from pathlib import Path

    from uvms_bringup.campaign.file import load_campaign
    from uvms_bringup.campaign.results import check_picture
    from uvms_bringup.campaign.runner import CampaignRunner
    from uvms_bringup.errors import CampaignError
    from uvms_bringup.folder import new_folder

    if options.resume and not options.output:
        raise CampaignError("--resume: say with --output DIR which campaign to go on with")
    if options.picture:
        check_picture(options.picture)
    campaign = load_campaign(options.campaign)
    folder = Path(options.output or new_folder(campaign.campaign)).resolve()
    runner = CampaignRunner(
        options.workers or _cores(),
        options.scheduler,
        options.resume,
        options.select,
        options.logs,
        lambda line: print(line, flush=True),
    )
    print(f"{campaign.campaign}: {campaign.description}".rstrip(": "), flush=True)
    results, stopped = runner.run(campaign, folder, options.command_line)
    print(text(results))
    if options.picture and results.rows:
        results.draw(options.picture)
    for note in results.notes():
        print(f"note: {note}", file=sys.stderr)
    if stopped is not None:
        made, planned = len(results.rows), sum(len(one.seeds) for one in results.variants)
        print(
            f"{stopped}: {made} of {planned} made; go on with --resume --output {folder}",
            file=sys.stderr,
        )
        return stopped.exit_code
    return 0 if results.passed == len(results.judged) else 1


def text(results: "Results") -> str:
    """What came out, case by case, for the terminal."""
    from uvms_bringup.campaign.results import PAGE_FILE

    cases = results.summary()["cases"]
    width = max(map(len, cases), default=0)
    lines = []
    for name, case in cases.items():
        low, high = case["wilson_95"]
        beside = "".join(
            f"  {other}: {found['passed']} of {found['runs']}"
            for other, found in case["baselines"].items()
        )
        lines.append(
            f"{name:{width}}  {case['passed']:4d} of {case['runs']} passed"
            f"  ({100 * low:.0f}-{100 * high:.0f} %){beside}"
        )
    made = len(results.judged)
    if made < results.planned:
        lines.append(
            f"{made} of {results.planned} runs are made; {results.passed} of these kept all that is"
            " required"
        )
    else:
        lines.append(f"{results.passed} of {made} runs kept all that is required")
    if results.rows:
        lines.append(f"page: {results.folder / PAGE_FILE}")
    return "\n".join(lines)


def _count(word: str) -> int:
    if not word.isdigit() or not 1 <= int(word) <= 1024:
        raise ArgumentTypeError(f"{word!r} must be a whole number from 1 to 1024")
    return int(word)


def _cores() -> int:
    """Cores that this process may use."""
    import os

    return len(os.sched_getaffinity(0))


COMMAND = Command("many runs on all cores or a cluster, judged by requirements", add_arguments, run)
