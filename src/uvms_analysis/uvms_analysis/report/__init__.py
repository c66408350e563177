"""`uvms report`: a page about a run, or about several side by side, and a picture in 3-D."""

import io
import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError, determine
from uvms_analysis.log.read import RunLog
from uvms_analysis.report import style
from uvms_analysis.report.page import Pictures, write_page
from uvms_analysis.report.run import ReportedRun
from uvms_analysis.report.scene import draw_scene, scene
from uvms_analysis.report.shown import show
from uvms_analysis.summary import summarise

__all__ = ["PAGE", "draw_scene", "report"]

PAGE = "report.html"

Scene = Callable[[Path], str]
"""Makes a self-contained HTML page of a log, with the motion in 3-D; LogError where it cannot."""


def report(log: str | Path, output: str | Path | None = None, in_3d: Scene | None = None) -> Path:
    """Write `report.html` about a log: self-contained, with interactive plots; returns it.

    Args:
        log: MCAP file of a run.
        output: folder of the page; None: the log's own.
        in_3d: makes the 3-D page that is embedded; None: there is none.

    Raises:
        LogError: the log cannot be read, or the folder cannot be written.
    """
    run = RunLog.open(log)
    folder = Path(output) if output is not None else run.path.parent
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as fault:
        raise LogError(f"{folder}: cannot be written: {fault.strerror}") from fault
    summary = summarise(run, wall_s=_wall_s(run))
    shown = show([ReportedRun(run.path.stem, run, summary)])
    return write_page(folder / PAGE, run, summary, shown, _pictures(run, in_3d))


def _wall_s(run: RunLog) -> float | None:
    """Wall time, which no log knows, from the summary beside it; None where there is none."""
    beside = run.path.parent / "summary.json"
    try:
        return float(json.loads(beside.read_text(encoding="utf-8"))["wall_s"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _pictures(run: RunLog, in_3d: Scene | None) -> Pictures:
    reasons = []
    picture = page = None
    try:
        picture = determine(partial(_drawn, run))
    except LogError as fault:
        reasons.append(f"No picture: {fault}")
    if in_3d is not None:
        try:
            page = determine(lambda: in_3d(run.path))
        except LogError as fault:
            reasons.append(f"Not in 3-D: {fault}")
    return Pictures(picture, page, tuple(reasons))


def _drawn(run: RunLog) -> bytes:
    data = io.BytesIO()
    with style.settings():
        scene(Analysis(run)).savefig(data, format="png")
    return data.getvalue()
