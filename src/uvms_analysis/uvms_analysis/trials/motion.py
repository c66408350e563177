"""A smooth motion of the arm through its measured angles."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_lsq_spline

from uvms_analysis.trials.convention import joint_angles
from uvms_analysis.trials.read import Trial
from uvms_core.signals import Array
from uvms_dynamics.simulation.prescribed import PrescribedJoints

SAMPLES_PER_KNOT = 5
"""At 25 Hz a knot every 0.2 s: the spline follows the arm, not the encoders' quantisation."""

LONGEST_STEP_S = 0.05
"""Far below the two or three seconds of a roll or pitch period."""

_CUBIC = 3


def joint_motion(trial: Trial) -> tuple[PrescribedJoints, NDArray[np.int64]]:
    """The motion for `float_freely`, and the index (k,) of each sample among its states.

    A least-squares cubic spline of the measured angles: its accelerations are continuous and match
    its angles and rates. A gap between samples is divided into several steps.
    """
    cuts = np.maximum(1, np.ceil(np.diff(trial.t) / LONGEST_STEP_S - 1e-9).astype(int))
    index = np.concatenate([[0], np.cumsum(cuts)])
    edges = np.interp(np.arange(index[-1] + 1), index, trial.t)
    times = np.sort(np.concatenate([edges, 0.5 * (edges[1:] + edges[:-1])]))
    spline = _spline(trial.t, joint_angles(trial.alpha))
    rows = [np.ascontiguousarray(spline(times, order)) for order in range(3)]
    return PrescribedJoints(np.diff(edges), *rows), index


def _spline(t: Array, angles: Array) -> BSpline:
    inner = t[SAMPLES_PER_KNOT:-SAMPLES_PER_KNOT:SAMPLES_PER_KNOT]
    ends = [t[0]] * (_CUBIC + 1), [t[-1]] * (_CUBIC + 1)
    return make_lsq_spline(t, angles, np.concatenate([ends[0], inner, ends[1]]), _CUBIC)
