"""The table of `uvms validate` as text, and its CSV files."""

import math
from pathlib import Path

import numpy as np

from uvms_analysis.trials.read import Trial
from uvms_analysis.trials.score import AXES, Score, medians
from uvms_core.signals import Array

SENSOR = "attitude sensor"
"""Row of the vehicle's own sensor, where the trials have its columns."""

Scores = dict[str, list[tuple[Score, Score]]]
"""Of each model, the scores of each trial."""

_HEAD = f"{'trial':<18}{'axis':<7}{'model':<16}{'RMSE deg':>9}{'no offset':>11}{'correlation':>13}"


LEGEND = """\
RMSE: root mean square of predicted minus measured, over the samples with moc_ok = 1.
no offset: the same after each trial's mean error is removed.
correlation: of predicted and measured; - where one of them is constant."""

SENSOR_LEGEND = """\
attitude sensor: the vehicle's own (imu_roll, imu_pitch) scored like a model, one offset for all
trials removed; `no offset`: one for each trial."""


def table_text(names: list[str], table: Scores) -> str:
    """A row for each trial, axis and model, and the medians over the trials."""
    lines = [_HEAD]
    for number, name in enumerate(names):
        lines += _rows(name, {model: rows[number] for model, rows in table.items()})
    lines.append("-" * len(_HEAD))
    lines += _rows(f"median of {len(names)}", {m: medians(rows) for m, rows in table.items()})
    lines += ["", LEGEND]
    if SENSOR in table:
        lines.append(SENSOR_LEGEND)
    return "\n".join(lines)


def _rows(name: str, both: dict[str, tuple[Score, Score]]) -> list[str]:
    lines = []
    for axis, label in enumerate(AXES):
        for model, score in both.items():
            metrics = f"{score[axis].rmse:9.2f}{score[axis].rmse_without_offset:11.2f}"
            tail = _correlation(score[axis].correlation)
            lines.append(f"{name:<18}{label:<7}{model:<16}{metrics}{tail:>13}")
    return lines


def _correlation(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.3f}"


def write_csv(trial: Trial, tilt: Array, folder: Path) -> Path:
    """`t,roll,pitch` of the trial on its own time grid; degrees, the trials' convention."""
    path = folder / f"{trial.name}.csv"
    rows = np.column_stack([trial.t, tilt])
    np.savetxt(path, rows, fmt=("%.6g", "%.4f", "%.4f"), delimiter=",", header="t,roll,pitch",
               comments="")  # fmt: skip
    return path
