"""What the first moments of a trial tell: the initial state, and the trim of the day."""

from typing import NamedTuple

import numpy as np

from uvms_analysis.trials.convention import FLIP, position_down, quaternion
from uvms_analysis.trials.read import Trial
from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.prescribed import STATE

WINDOW_S = 0.5
"""The initial state is the mean over so long a time; nothing later is ever looked at."""

TRIM_STAYS = 0.3
TRIM_FADES_S = 5.0
"""Of the tilt at the start beside the model's rest so much stays; the others fade in this time.

Cross-validated: docs/validation.md.
"""


class Start(NamedTuple):
    """Measured initial state."""

    state: Array  # (13,) position, quaternion, body velocity: ours
    tilt: Array  # (2,) roll and pitch in degrees, the trials' convention


def measured_start(trial: Trial) -> Start:
    """Mean position, attitude and rates, and the slope of the position, over the first window.

    Samples that the motion capture does not vouch for are left out where others are there.
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
