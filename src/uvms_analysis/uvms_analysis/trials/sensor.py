"""The vehicle's own attitude sensor scored like a model: how far two instruments disagree."""

from collections.abc import Sequence

import numpy as np

from uvms_analysis.trials.read import Trial
from uvms_core.signals import Array


def sensor_tilts(trials: Sequence[Trial]) -> list[Array] | None:
    """Roll and pitch (k, 2) of the sensor, degrees, of each trial; None unless all have them.

    One common offset is removed, the mean over the trials of their mean differences from the motion
    capture, since the two instruments are not aligned.
    """
    pairs = [(trial, trial.sensor) for trial in trials if trial.sensor is not None]
    if len(pairs) < len(trials):
        return None
    off = [(own - trial.tilt)[trial.accepted].mean(axis=0) for trial, own in pairs]
    offset = np.mean(off, axis=0)
    return [own - offset for _, own in pairs]
