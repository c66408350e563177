"""How far the vehicle's inertial unit is off, beside what its file says of it.

Attitude: the difference e of unit and motion capture, its mean over a trial and its wandering,
the root mean square of (e(t + tau) - e(t)) / sqrt(2), an Allan-like deviation that is defined for
bias and noise alike. A Gauss-Markov bias of std s and time constant T makes it
s sqrt(1 - exp(-tau / T)) (Gelb, Applied Optimal Estimation, 1974, sec. 3.8).

Specific force: the mean of what it is off gravity in the unit's own attitude; the motions are far
too slow for anything else.
"""

from collections.abc import Sequence

import numpy as np

from uvms_analysis.trials.convention import FLIP, quaternion
from uvms_analysis.trials.read import Trial
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import quat_to_matrix

LAGS_S = (1.0, 5.0, 20.0)
"""Lags of the wandering: from an attitude filter's noise to a trial's length."""
_HEAD = f"{'inertial unit':<36}{'roll':>14}{'pitch':>14}{'heading':>14}"

LEGEND = """\
Attitude: unit minus motion capture, degrees; mean: root mean square of the trials' means; wandering
in tau: root mean square of the change in tau over sqrt(2). In brackets: what the vehicle file's
biases make of it.
Specific force: mean less gravity in the unit's attitude, m/s^2, root mean square of the trials."""


def unit_text(trials: Sequence[Trial], vehicle: Vehicle) -> str:
    """Of every second trial, from which the file's values are, and of the others."""
    lines = [_HEAD]
    for label, half in (("1st, 3rd ...", trials[::2]), ("2nd, 4th ...", trials[1::2])):
        if half:
            lines += _rows(label, half, vehicle)
    return "\n".join([*lines, "", LEGEND])


def _rows(label: str, trials: Sequence[Trial], vehicle: Vehicle) -> list[str]:
    imu = vehicle.sensors.imu
    std = np.array([imu.roll_pitch_bias_deg, imu.roll_pitch_bias_deg, imu.heading_bias_deg])
    errors = [attitude_error(trial) for trial in trials]
    means = _rms([np.nanmean(error, axis=0) for error in errors])
    means[2] = np.nan  # the two headings have arbitrary zeros
    rows = [_row(f"{label} attitude, mean", means, std)]
    for lag in LAGS_S:
        expected = std * np.sqrt(1.0 - np.exp(-lag / imu.bias_time_constant_s))
        rows.append(
            _row(f"{label} wandering in {lag:g} s", wandering(trials, errors, lag), expected)
        )
    force = _rms([force_offset(trial) for trial in trials])
    bias = np.full(3, imu.accelerometer_bias_m_s2)
    return [*rows, _row(f"{label} specific force x, y, z", force, bias)]


def _row(label: str, found: Array, expected: Array) -> str:
    cells = [
        f"{'-' if np.isnan(one) else format(one, '.2f')} ({other:.2f})"
        for one, other in zip(found, expected, strict=True)
    ]
    return f"{label:<36}" + "".join(f"{cell:>14}" for cell in cells)


def attitude_error(trial: Trial) -> Array:
    """Roll, pitch and heading (k, 3) of unit minus motion capture, degrees; nan if not scored."""
    assert trial.inertial is not None
    error = np.degrees(np.unwrap(np.radians(trial.inertial[:, :3] - trial.attitude), axis=0))
    error[~trial.accepted] = np.nan
    return error


def wandering(trials: Sequence[Trial], errors: Sequence[Array], lag: float) -> Array:
    """Root mean square of the change of the error in `lag` s over sqrt(2), (3,) degrees.

    nan where no trial is as long.
    """
    changes = [np.empty((0, 3))]
    for trial, error in zip(trials, errors, strict=True):
        shift = round(lag / float(np.median(np.diff(trial.t))))
        changes.append(error[shift:] - error[:-shift])
    known = [change[~np.isnan(change).any(axis=1)] for change in changes]
    found = np.concatenate(known)
    return np.sqrt(0.5 * np.mean(found**2, axis=0)) if len(found) else np.full(3, np.nan)


def force_offset(trial: Trial) -> Array:
    """Mean specific force less gravity in the unit's attitude, (3,) m/s^2, our body axes.

    Gravity is what the trial's mean length of the specific force says: a scale error, which no
    slow motion shows, is no bias.
    """
    assert trial.inertial is not None
    force = trial.inertial[:, 3:] * FLIP
    up = -np.array([quat_to_matrix(quaternion(each))[2] for each in trial.inertial[:, :3]])
    gravity = float(np.linalg.norm(force, axis=1).mean())
    return np.asarray((force - gravity * up).mean(axis=0))


def _rms(values: Sequence[Array]) -> Array:
    return np.asarray(np.sqrt(np.mean(np.square(values), axis=0)))
