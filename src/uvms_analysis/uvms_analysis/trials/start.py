"""The initial state of a trial, and the initial trim offset that its first moments show."""

from typing import NamedTuple

import numpy as np

from uvms_analysis.trials.convention import FLIP, position_down, quaternion
from uvms_analysis.trials.read import Trial
from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.prescribed import STATE

WINDOW_S = 0.5
"""Length of the window that gives the initial state; no later sample is used."""

TRIM_STAYS = 0.3
TRIM_FADES_S = 5.0
"""Share of the initial trim offset that stays, and time constant with which the rest fades.

Cross-validated: docs/validation.md.
"""


class Start(NamedTuple):
    """Measured initial state."""

    state: Array  # (13,) position, quaternion, body velocity: ours
    tilt: Array  # (2,) roll and pitch in degrees, the trials' convention


def measured_start(trial: Trial) -> Start:
    """Mean position, attitude and rates, and the slope of the position, over the first window.

    Samples that the motion capture marks as bad are left out if at least two good ones remain.
    """
    window = trial.t <= trial.t[0] + WINDOW_S
    if (window & trial.accepted).sum() >= 2:
        window &= trial.accepted
    turned = np.rad2deg(np.unwrap(np.deg2rad(trial.attitude[:, 2])))
    attitude = np.append(trial.tilt[window].mean(axis=0), turned[window].mean())
    slope, place = _line(trial.t[window] - trial.t[0], position_down(trial.position[window]))
    state = np.zeros(STATE)
    state[:3], state[3:7] = place, quaternion(attitude)
    state[7:10] = quat_to_matrix(state[3:7]).T @ slope
    state[10:] = trial.gyro[window].mean(axis=0) * FLIP
    return Start(state, attitude[:2])


def _line(t: Array, values: Array) -> tuple[Array, Array]:
    """Slope and value at t = 0 of the least-squares line through each column."""
    if len(t) < 2:
        return np.zeros(values.shape[1]), values[0]
    fit = np.polyfit(t, values, 1)
    return fit[0], fit[1]
