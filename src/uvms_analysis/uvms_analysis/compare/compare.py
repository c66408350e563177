"""Runs side by side: their logs, summaries, table, figures and page."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_analysis.analysis import Analysis
from uvms_analysis.compare import page
from uvms_analysis.compare.table import Row, differences
from uvms_analysis.errors import LogError
from uvms_analysis.flat import flatten
from uvms_analysis.log.locate import log_path
from uvms_analysis.log.read import RunLog
from uvms_analysis.summary import summarise


@dataclass(frozen=True)
class Compared:
    """The runs by name, what differs between them, and the page."""

    names: tuple[str, ...]
    rows: tuple[Row, ...]
    page: Path


def compare(runs: Sequence[str | Path], output: str | Path) -> Compared:
    """Compare runs, given by their folders or logs; writes figures and `compare.html`.

    Raises:
        LogError: there are fewer than two, a log cannot be read, or the folder not be written.
    """
    if len(runs) < 2:
        raise LogError("compare: give at least two runs")
    logs = [RunLog.open(log_path(run)) for run in runs]
    names = names_of([log.path for log in logs])
    summaries = [flatten(_summary(log)) for log in logs]
    rows = tuple(differences(summaries))
    folder = Path(output)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise LogError(f"{folder}: cannot be written: {fault.strerror}") from fault
    analyses = dict(zip(names, map(Analysis, logs), strict=True))
    return Compared(names, rows, page.write(folder, analyses, rows))


def _summary(log: RunLog) -> dict[str, Any]:
    """The summary beside a log, which knows the wall time; else one made from the log."""
    try:
        found = json.loads((log.path.parent / "summary.json").read_text(encoding="utf-8"))
        if isinstance(found, dict) and "outcome" in found:
            return found
    except (OSError, ValueError):
        pass
    return summarise(log, wall_s=None)


def names_of(paths: Sequence[Path]) -> tuple[str, ...]:
    """A short name for each log: of its folder, or of the file where that is not `run.mcap`.

    As many folders above are added as it takes to tell them apart.
    """
    parts = [_parts(path.resolve()) for path in paths]
    for count in range(1, max(map(len, parts)) + 1):
        names = tuple("/".join(each[-count:]) for each in parts)
        if len(set(names)) == len(names):
            return names
    return tuple(f"{'/'.join(each[-1:])} ({k})" for k, each in enumerate(parts, start=1))


def _parts(path: Path) -> tuple[str, ...]:
    return path.parent.parts if path.name == "run.mcap" else path.with_suffix("").parts
