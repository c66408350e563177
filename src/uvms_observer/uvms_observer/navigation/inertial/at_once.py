"""One sample of the inertial unit in one call: the usual case of what `Estimator` does in steps.

That is: a reading near the last one, no gap before it, a gyrocompass that is believed. The sample
carries the state, then its attitude corrects it.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_observer.navigation.measurements.imu import correct_attitude
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.state import WIDEST, Fields

UNUSUAL = -1.0
"""Returned where nothing has been done: the screen has to judge."""


@exact_kernel
def take_inertial(
    fields: Fields,
    rate_before: Array,
    rate: Array,
    rate_limit: float,
    force_before: Array,
    force: Array,
    force_limit: float,
    dt: float,
    gravity: float,
    gyro: float,
    accelerometer: float,
    period: float,
    variance: Array,
    decay: Array,
    quaternion: Array,
    compass_variance: Array,
    gate: float,
    mean: Array,
    keep: float,
) -> tuple[float, Array]:
    """Propagate, then correct by the attitude unless it is beyond the gate, in place.

    Args:
        fields: of the state.
        rate_before, rate, force_before, force: readings at both ends, (3,), as `propagate`.
        rate_limit, force_limit: largest change, along any axis, of a reading that is believed.
        dt: since the time of the state, s.
        gravity, gyro, accelerometer, period, variance, decay: as `propagate`.
        quaternion, compass_variance, gate: as `correct_attitude`.
        mean: (WIDEST,) running mean of the residuals before.
        keep: share of it that stays.

    Returns:
        The squared distance of the attitude's residual, or `UNUSUAL`; and the mean with it.
    """
    for i in range(3):
        if (
            abs(rate[i] - rate_before[i]) > rate_limit
            or abs(force[i] - force_before[i]) > force_limit
        ):
            return UNUSUAL, mean
    if dt > 0.0:
        propagate(
            fields,
            rate_before,
            rate,
            force_before,
            force,
            dt,
            gravity,
            gyro,
            accelerometer,
            period,
            variance,
            decay,
        )
    distance = correct_attitude(fields, quaternion, compass_variance, gate)
    innovation, after = fields[8], np.zeros(WIDEST)
    weight = np.sqrt(1.0 - keep * keep)
    for i in range(3):
        after[i] = keep * mean[i] + weight * innovation[0, i] / innovation[2, i]
    return distance, after
