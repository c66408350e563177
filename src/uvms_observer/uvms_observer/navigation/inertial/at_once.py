"""Samples of the inertial unit in one call: the usual case of what `Estimator` does in steps.

That is: readings near the one before them, no gaps between them, all as noisy as they say, a
gyrocompass that is believed. Each carries the state, then its attitude corrects it.
"""

from collections.abc import Callable, Sequence
from itertools import chain
from operator import attrgetter, is_not

import numpy as np

from uvms_core.signals import NANOSECONDS, Array, ImuSample
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_observer.navigation.inertial.installation import Stated
from uvms_observer.navigation.inertial.unknown_motion import GAP
from uvms_observer.navigation.measurements.imu import correct_attitude
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import Fields
from uvms_observer.navigation.trust.innovation_gate import followed

QUATERNION, RATE, FORCE, WIDTH = 0, 4, 7, 10
"""Where they begin in a row of `packed`, and how long it is."""
_PARTS = attrgetter("quaternion", "angular_velocity", "linear_acceleration")
_COVARIANCES = attrgetter(
    "orientation_covariance", "angular_velocity_covariance", "linear_acceleration_covariance"
)


def alike(
    readings: Sequence[Reading], unit: str, excess_of: Callable[[ImuSample], Stated]
) -> tuple[list[ImuSample], Stated | None]:
    """The unit's samples that come first, with an attitude, and all as noisy as they say.

    Args:
        readings: in the order of their stamps.
        unit: its name.
        excess_of: what noise a sample states.

    Returns:
        The samples, and what they state; None where there are none.
    """
    samples: list[ImuSample] = []
    stated: Stated | None = None
    before: tuple[Array, ...] = ()
    for _, _, name, sample in readings:
        if name != unit or not sample.oriented:
            break
        covariances = _COVARIANCES(sample)
        if stated is None or any(map(is_not, covariances, before)):  # many share their arrays
            excess = excess_of(sample)
            if stated is not None and excess != stated:
                break
            before, stated = covariances, excess
        samples.append(sample)
    return samples, stated


def packed(samples: Sequence[ImuSample]) -> tuple[Array, Array]:
    """Stamps (k,) ns, and attitudes, rates and forces (k, WIDTH), of samples."""
    parts = tuple(chain.from_iterable(map(_PARTS, samples)))
    stamps = np.array([sample.stamp for sample in samples])
    return stamps, np.concatenate(parts).reshape(-1, WIDTH)


@exact_kernel
def take_inertial(
    fields: Fields,
    stamps: Array,
    rows: Array,
    time: int,
    last: int,
    rate: Array,
    force: Array,
    rate_jump: float,
    angular_jerk: float,
    force_jump: float,
    jerk: float,
    gravity: float,
    gyro: float,
    accelerometer: float,
    period: float,
    variance: Array,
    decay: Array,
    compass_variance: Array,
    gate: float,
    total: float,
    level: float,
    mean: Array,
    size: int,
    keep: float,
    new: float,
) -> tuple[int, bool, float, float, Array]:
    """Propagate to each sample, then correct by its attitude, in place, as long as all is usual.

    Args:
        fields: of the state.
        stamps, rows: of the samples, as `packed`.
        time: of the state, ns.
        last: stamp of the last sample before these, ns.
        rate, force: what the unit reads at `time`, (3,) rad/s and m/s^2.
        rate_jump, angular_jerk, force_jump, jerk: by how much a reading that is believed may
            change along any axis, at once and by the second.
        gravity, gyro, accelerometer, period, variance, decay: as `propagate`.
        compass_variance, gate: as `correct_attitude`.
        total, level, mean, size, keep, new: as `followed`.

    Returns:
        How many samples have been taken; whether the attitude of the last of them was within the
        gate, which ends the run where it was not; and total, level and mean after them. Nothing has
        been done with the next one, of which the screen has to judge.
    """
    fits, taken = True, 0
    while fits and taken < stamps.shape[0]:
        stamp, row = stamps[taken], rows[taken]
        next_rate, next_force = _part(row, RATE), _part(row, FORCE)
        gone = (stamp - last) / NANOSECONDS
        if gone > GAP * period or not (
            _is_near(rate, next_rate, rate_jump + angular_jerk * gone)
            and _is_near(force, next_force, force_jump + jerk * gone)
        ):
            break
        if stamp > time:
            propagate(
                fields,
                rate,
                next_rate,
                force,
                next_force,
                (stamp - time) / NANOSECONDS,
                gravity,
                gyro,
                accelerometer,
                period,
                variance,
                decay,
            )
            time = stamp
        distance = correct_attitude(fields, row[QUATERNION:RATE].copy(), compass_variance, gate)
        fits = distance <= gate
        if fits:
            total, level, mean = followed(total, level, mean, distance, fields[8], size, keep, new)
        last, rate, force = stamp, next_rate, next_force
        taken += 1
    return taken, fits, total, level, mean


@exact_inner
def _part(row: Array, begin: int) -> Array:
    """Three values of a row."""
    part = np.empty(3)
    for i in range(3):
        part[i] = row[begin + i]
    return part


@exact_inner
def _is_near(before: Array, reading: Array, limit: float) -> bool:
    for i in range(3):
        if abs(reading[i] - before[i]) > limit:
            return False
    return True
