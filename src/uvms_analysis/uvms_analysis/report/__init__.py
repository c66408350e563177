"""`uvms report`: figures of a run in the style of the paper's Figs. 7-9, and a page about it."""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

from matplotlib.figure import Figure

from uvms_analysis.analysis import Analysis
from uvms_analysis.errors import LogError, determine
from uvms_analysis.log.read import RunLog
from uvms_analysis.report import force_figures, motion_figures, style
from uvms_analysis.report.clearance_figure import clearance
from uvms_analysis.report.disturbance_figure import planned_disturbance
from uvms_analysis.report.page import Picture, write_page
from uvms_analysis.report.scene import draw_scene, scene
from uvms_analysis.report.stability_figure import stability
from uvms_analysis.summary import summarise

__all__ = ["FIGURES", "draw_scene", "report"]

FIGURES: dict[str, tuple[str, Callable[[Analysis], Figure]]] = {
    "scene": (
        "The vehicle at work. Ghosts: other postures; tube: true path of the tool, enlarged in the "
        "corner; arrows: thrusts and disturbance at the time of the solid posture.",
        scene,
    ),
    "end_effector": (
        "End effector: true position against its target, and the error between them.",
        motion_figures.end_effector,
    ),
    "joints": ("Joint angles, true and as planned.", motion_figures.joints),
    "attitude": ("Attitude of the vehicle, true and estimated.", motion_figures.attitude),
    "vehicle": ("Pose of the vehicle, true and as planned.", motion_figures.vehicle),
    "clearance": (
        "Distances of bodies that must not touch, true and as planned; those that come closest.",
        clearance,
    ),
    "self_disturbance": (
        "Self-disturbance: restoring and coupling wrench on the vehicle, body frame. "
        "Grey: as observed.",
        force_figures.self_disturbance,
    ),
    "planned_disturbance": (
        "Self-disturbance as planned and as it was: restoring plus coupling wrench on the vehicle, "
        "body frame.",
        planned_disturbance,
    ),
    "stability": (
        "Stability of the vehicle's loop by the controller's own account: Lyapunov function of "
        "eq. (27), its rate, and both sides of the condition below eq. (29), which is sufficient "
        "and not necessary.",
        stability,
    ),
    "thrusters": ("Thrust as allocated; dotted: limits.", force_figures.thrusters),
    "navigation": (
        "Estimated minus true position, with the filter's own standard deviation.",
        force_figures.navigation,
    ),
}


def report(log: str | Path, output: str | Path | None = None) -> Path:
    """Draw all figures of a log and write `report.html`; returns the page.

    Args:
        log: MCAP file of a run.
        output: folder for figures and page; None: the log's own.

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
    pictures = _draw(Analysis(run), folder)
    return write_page(folder / "report.html", run, summary, pictures)


def _wall_s(run: RunLog) -> float | None:
    """Wall time, which no log knows, from the summary beside it; None where there is none."""
    beside = run.path.parent / "summary.json"
    try:
        return float(json.loads(beside.read_text(encoding="utf-8"))["wall_s"])
    except (OSError, ValueError, KeyError, TypeError):
        return None


def _draw(run: Analysis, folder: Path) -> list[Picture]:
    pictures = []
    for name, (caption, draw) in FIGURES.items():
        path = folder / f"{name}.png"
        try:
            with style.settings():
                determine(partial(_save, draw, run, path))
        except LogError as fault:
            pictures.append(Picture(name, caption, None, str(fault)))
        else:
            pictures.append(Picture(name, caption, path))
    return pictures


def _save(draw: Callable[[Analysis], Figure], run: Analysis, path: Path) -> None:
    draw(run).savefig(path)
