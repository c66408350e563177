"""Runs side by side: their logs, summaries, table and page."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_analysis.check import Check, check_log
from uvms_analysis.compare import page
from uvms_analysis.compare.table import SCENARIO, VEHICLE, Row, differences
from uvms_analysis.errors import LogError
from uvms_analysis.flat import flatten
from uvms_analysis.log.locate import log_path
from uvms_analysis.log.read import RunLog
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.summary import summarise

SUMMARY_FILE = "summary.json"
MOST_FAULTS = 3
"""Faults of a log that a warning names."""
CAMPAIGN_FILE = "campaign.yaml"
"""In the folder of a campaign, which is no run."""


@dataclass(frozen=True)
class Compared:
    """The runs by name, what differs between them, what is wrong with them, and the page."""

    names: tuple[str, ...]
    rows: tuple[Row, ...]
    warnings: tuple[str, ...]
    page: Path


def compare(runs: Sequence[str | Path], output: str | Path) -> Compared:
    """Compare runs, given by their folders or logs; writes `compare.html`.

    Raises:
        LogError: there are fewer than two, a log cannot be read, or the folder not be written.
    """
    if len(runs) < 2:
        raise LogError("compare: give at least two runs")
    logs = [RunLog.open(_log_of(run)) for run in runs]
    names = names_of([log.path for log in logs])
    found = [_summary(log) for log in logs]
    warnings = tuple(
        f"{name}: {text}" for name, (_, texts) in zip(names, found, strict=True) for text in texts
    )
    summaries = [
        _about(log) | flatten(summary) for log, (summary, _) in zip(logs, found, strict=True)
    ]
    rows = tuple(differences(summaries))
    folder = Path(output)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise LogError(f"{folder}: cannot be written: {fault.strerror}") from fault
    reported = [
        ReportedRun(name, log, summary)
        for name, log, (summary, _) in zip(names, logs, found, strict=True)
    ]
    return Compared(names, rows, warnings, page.write_page(folder, reported, rows, warnings))


def _log_of(run: str | Path) -> Path:
    """The log of a run.

    Raises:
        LogError: there is none; of a campaign, says where its logs are.
    """
    folder = Path(run)
    if not (folder / CAMPAIGN_FILE).is_file():
        return log_path(run)
    logs = sorted(log.parent for log in folder.glob("logs/*/run.mcap"))
    if logs:
        more = "" if len(logs) == 1 else f" (and {len(logs) - 1} more)"
        raise LogError(f"{folder}: is a campaign; give runs of it, such as {logs[0]}{more}")
    raise LogError(
        f"{folder}: is a campaign without logs; run it with --logs all, or make the log of a row"
        f" with uvms simulate --again {folder} CASE SEED"
    )


def _about(log: RunLog) -> dict[str, Any]:
    """Vehicle and scenario, which are shown even where they are the same."""
    try:
        vehicle = log.vehicle.name
    except LogError:
        vehicle = None
    return {VEHICLE: vehicle, SCENARIO: log.run.get("scenario")}


def _summary(log: RunLog) -> tuple[dict[str, Any], list[str]]:
    """The summary, and what is wrong with the log.

    The summary beside the log knows the wall time; that of a damaged log, and one that is not of
    this log, are left aside for one that is made from what is there.
    """
    check = check_log(log)
    warnings = [] if check.complete else [_what_is_wrong(check)]
    try:
        found = json.loads((log.path.parent / SUMMARY_FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        found = None
    if not isinstance(found, dict) or "outcome" not in found:
        return summarise(log, wall_s=None), warnings
    if why := _does_not_fit(log, found, check):
        warnings.append(
            f"{SUMMARY_FILE} is left aside, and its values are made from the log: {why}"
        )
        return summarise(log, wall_s=None), warnings
    return found, warnings


def _what_is_wrong(check: Check) -> str:
    """The first faults of a log, and where to see the others."""
    text = "; ".join(map(str, check.faults[:MOST_FAULTS]))
    more = len(check.faults) - MOST_FAULTS
    rest = f"; and {more} more, see uvms check {check.path}" if more > 0 else ""
    return f"its log is {check.verdict}: {text}{rest}"


def _does_not_fit(log: RunLog, summary: Mapping[str, Any], check: Check) -> str:
    """Why a summary is not that of the log beside it; empty where it is."""
    was = summary.get("check")
    if isinstance(was, Mapping) and list(map(str, check.faults)) != was.get("faults"):
        return "it was made when the log was another, or was not damaged yet"
    own, told = log.run.get("run_id"), summary.get("run_id")
    if own and told and own != told:
        return f"it is of the run {told}, the log is of {own}"
    return ""


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
