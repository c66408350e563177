"""Figures of `uvms validate --figures`: every trial's roll and pitch, and the errors."""

import math
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from uvms_analysis.report import style
from uvms_analysis.trials.outcome import Outcome, table
from uvms_analysis.trials.score import AXES

COLUMNS = 4
MIN_SPAN_DEG = 3.0
"""Least height of an axis, so that noise does not look like motion."""

_LOOKS: dict[str, dict[str, Any]] = {
    "dynamic model": {"color": style.COLORS[0], "linewidth": 1.3, "zorder": 3},
    "quasi-static": {"color": style.COLORS[4], "linewidth": 0.9, "zorder": 2},
}
_MARKS = {"dynamic model": "o", "quasi-static": "s", "constant": "x", "attitude sensor": "+"}


def draw(found: list[Outcome], folder: Path) -> list[Path]:
    """`trials_roll.png`, `trials_pitch.png` and `trials_rmse.png` in the folder."""
    with style.settings():
        paths = [_trials(found, axis, folder) for axis in range(len(AXES))]
        return [*paths, _errors(found, folder)]


def _trials(found: list[Outcome], axis: int, folder: Path) -> Path:
    rows = math.ceil(len(found) / COLUMNS)
    figure = style.new_figure(1.55 * rows + 0.5)
    panels = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    for panel, each in zip(panels, found, strict=False):
        _trial(panel, each, axis)
    for panel in panels[len(found) :]:
        panel.set_axis_off()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper right", ncols=len(labels))
    figure.suptitle(f"{AXES[axis]} / deg against t / s", x=0.01, ha="left", fontsize=10)
    return _save(figure, folder / f"trials_{AXES[axis]}.png")


def _trial(panel: Axes, each: Outcome, axis: int) -> None:
    """One trial; samples that are not scored are left out of the measured line."""
    trial = each.trial
    measured = np.where(trial.accepted, trial.tilt[:, axis], np.nan)
    panel.plot(trial.t, measured, color="black", linewidth=0.9, label="measured")
    for model, look in _LOOKS.items():
        panel.plot(trial.t, each.predicted[model].tilt[:, axis], label=model, **look)
    shown = np.concatenate(
        [trial.tilt[trial.accepted, axis], each.predicted["dynamic model"].tilt[:, axis]]
    )
    style.room(panel, shown, MIN_SPAN_DEG)
    panel.set_title(trial.name, fontsize=8)
    panel.margins(x=0.0)


def _errors(found: list[Outcome], folder: Path) -> Path:
    """RMSE of every trial by model, for both axes."""
    figure = style.new_figure(0.2 * len(found) + 1.3)
    panels = figure.subplots(1, len(AXES), sharey=True)
    places = np.arange(len(found))
    for axis, panel in enumerate(panels):
        for k, (model, rows) in enumerate(table(found).items()):
            values = [row[axis].rmse for row in rows]
            panel.plot(values, places, _MARKS[model], color=style.COLORS[k], label=model)
            panel.axvline(float(np.median(values)), color=style.COLORS[k], linewidth=0.8)
        panel.set_xscale("log")
        panel.set_xlabel(f"RMSE of {AXES[axis]} / deg (lines: medians)")
    panels[0].set_yticks(places, [each.trial.name for each in found])
    panels[0].invert_yaxis()
    style.legend(panels[1])
    return _save(figure, folder / "trials_rmse.png")


def _save(figure: Figure, path: Path) -> Path:
    figure.savefig(path)
    return path
