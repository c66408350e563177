"""How far a predicted tilt is from the measured one."""

from typing import NamedTuple

import numpy as np

from uvms_analysis.trials.read import Trial
from uvms_core.signals import Array

AXES = ("roll", "pitch")


class Score(NamedTuple):
    """Metrics of one axis over the accepted samples of a trial."""

    rmse: float  # degrees
    rmse_without_offset: float  # degrees, after the mean error is taken off
    correlation: float  # of predicted and measured; nan where one of them is constant


def scores(trial: Trial, predicted: Array) -> tuple[Score, Score]:
    """Scores of roll and of pitch; predicted (k, 2) in degrees."""
    measured, model = trial.tilt[trial.accepted], predicted[trial.accepted]
    return _score(measured[:, 0], model[:, 0]), _score(measured[:, 1], model[:, 1])


def medians(table: list[tuple[Score, Score]]) -> tuple[Score, Score]:
    """Median over trials of every metric, for roll and for pitch; nan is left out."""
    roll, pitch = zip(*table, strict=True)
    return _median(roll), _median(pitch)


def _median(column: tuple[Score, ...]) -> Score:
    values = np.array(column)
    known = [row[~np.isnan(row)] for row in values.T]
    return Score(*(float(np.median(row)) if len(row) else float("nan") for row in known))


def _score(measured: Array, predicted: Array) -> Score:
    error = predicted - measured
    moves = min(float(np.std(measured)), float(np.std(predicted))) > 1e-9
    correlation = float(np.corrcoef(measured, predicted)[0, 1]) if moves else float("nan")
    return Score(float(np.sqrt(np.mean(error**2))), float(np.std(error)), correlation)
