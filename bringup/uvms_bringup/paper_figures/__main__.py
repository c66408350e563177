"""`make figures`: the paper's figures from runs of ours, into docs/paper-figures.md.

`python -m uvms_bringup.paper_figures [--docs DIR] [--from DIR]`: five runs are simulated, which
takes a few minutes, or read from the folder `--from` names. Exit code 2: that was not possible.
Statements of the paper that do not hold are in the page, and are printed.
"""

import json
import sys
import tempfile
from argparse import ArgumentParser
from collections.abc import Sequence
from pathlib import Path

from uvms_analysis.report import style
from uvms_bringup.paper_figures.draw import FIGURES
from uvms_bringup.paper_figures.numbers import beginning, numbers
from uvms_bringup.paper_figures.page import NUMBERS, PAGE, SECTIONS, page
from uvms_bringup.paper_figures.runs import MANIPULATION, Runs, read, simulated
from uvms_bringup.paper_figures.snapshots import write_snapshots
from uvms_core.errors import UvmsError

DIGITS = 4
"""Of the numbers that are kept: what comes after them differs from machine to machine."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the page, its figures and its numbers."""
    parser = ArgumentParser(prog="make figures", description="The paper's figures.")
    parser.add_argument("--docs", default="docs", metavar="DIR", help="default: %(default)s")
    parser.add_argument("--from", dest="taken", metavar="DIR", help="runs that are there")
    options = parser.parse_args(arguments)
    try:
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(options.taken or temporary)
            runs = read(folder) if options.taken else simulated(folder, say=_say)
            _write(runs, folder, Path(options.docs))
    except (UvmsError, OSError) as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    return 0


def _say(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _write(runs: Runs, folder: Path, docs: Path) -> None:
    found = {"numbers": _rounded(numbers(runs)), "beginning": _rounded(beginning(runs))}
    (docs / "figures").mkdir(parents=True, exist_ok=True)
    with style.settings():
        for section in SECTIONS:
            if section.number in FIGURES:
                FIGURES[section.number](runs).savefig(docs / section.picture)
            else:
                write_snapshots(folder / MANIPULATION, docs / section.picture)
    (docs / NUMBERS).write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    (docs / PAGE).write_text(page(found["numbers"]), encoding="utf-8")
    print(f"page: {docs / PAGE}")
    for claim in (claim for section in SECTIONS for claim in section.claims):
        if fault := claim.bound.fault(claim.key, found["numbers"][claim.key]):
            print(f"does not hold  {fault}")


def _rounded(values: dict[str, float]) -> dict[str, float]:
    return {name: float(f"{value:.{DIGITS}g}") for name, value in values.items()}


if __name__ == "__main__":
    raise SystemExit(main())
