"""What the samples of an inertial unit tell of the unit itself, before any state is compared.

- No vehicle under water feels less than 0.15 of gravity or more than five times as much, or
  turns by ten radians a second. A sample beyond that is none: gravity taken off, units of g, a
  broken part. Nor are rates or forces that are the same to the last bit for a while.
- An attitude that is the same to the last bit for longer has not been measured; rates and forces
  of such a sample still are.
- White noise makes the second difference of three samples, d = x - 2 x' + x'', of std sqrt(6) times
  its own; a vehicle's motion makes next to nothing of it. The median of |d| hence shows how noisy
  the unit is here and now, by vibration for example, whatever its spikes. Where that is more than
  the vehicle file says, it is stated as if the message had.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import ceil, sqrt
from typing import NamedTuple

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.signals import Array, ImuSample, to_nanoseconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_observer.navigation.inertial.at_once import packed
from uvms_observer.navigation.inertial.installation import known_variance
from uvms_observer.navigation.measurements.noise import most_alike

FORCE_G = (0.15, 5.0)
"""Sizes of the specific force that a vehicle may feel, over gravity's: one of ten times the weight
of the water that it displaces falls at 0.18."""
RATE_RAD_S = 10.0
"""Fastest turn."""
FROZEN_S = 0.15
"""How long rates or forces may be the same, at least: drivers repeat what has not come in time."""
ATTITUDE_FROZEN_S = 0.5
"""The same of attitudes, which many units compute at a tenth of the rate."""
RATE_FLOOR_RAD_S, FORCE_FLOOR_M_S2 = 1e-3, 0.02
"""Std of white noise that makes no difference, whatever the vehicle file says."""
QUIET, SEEN = 0.3, 30
"""So many |d| above this share of the median of a unit's noise show that it has noise at all: one
that is computed without, in a simulation or a test, may well read the same."""
ROUGH = 6.0
"""Times the noise of the vehicle file from which on it is noisier than that."""
KNOCK_S = 1.0
"""How long an arm that runs into its stops shakes the hull, s: such motion is real, and the screen
must see it. What goes on for longer is noise."""
STEP = 1.1
"""Factor by which the median goes up or down with each sample."""
ROW, FAR, LEAP = 7, 4.0, 3.0
"""So many |d| in a row that are so many times the median are no spikes, of which each makes three:
the median goes up by the last factor, and the samples since the first count as noisy as that."""
MEDIAN = 0.6745 * sqrt(6.0)
"""Of |d|, over the std of the noise."""

ATTITUDE, RATE, FORCE = range(3)
PARTS = ("quaternion", "angular_velocity", "linear_acceleration")


class Condition(NamedTuple):
    """Of the unit after its last sample; the kernel changes it in place."""

    values: Array  # (5, 6) rates and forces of the last two samples; medians of |d|; how many |d|
    # in a row have been far above it; of how many samples the noise has to be made up for
    seen: Array  # (3,) how many |d| of rates and of forces have been noise; how many samples in a
    # row have been rougher than that
    attitude: Array  # (4,) of the last one
    same: Array  # (3,) samples in a row that have been the same: attitude, rate, force
    times: Array  # (2,) ns, of the last two


class ConditionCheck:
    """Of one unit.

    Args:
        vehicle: its inertial unit.
    """

    def __init__(self, vehicle: Vehicle) -> None:
        imu = vehicle.sensors.imu
        gyro, tilt = np.radians([imu.gyro_noise_deg_s, imu.roll_pitch_noise_deg])
        force = imu.accelerometer_noise_m_s2
        self._noise = np.repeat([max(gyro, RATE_FLOOR_RAD_S), max(force, FORCE_FLOOR_M_S2)], 3)
        self._known = known_variance(imu)
        gravity = vehicle.environment.gravity_m_s2
        self._least, self._most = FORCE_G[0] * gravity, FORCE_G[1] * gravity
        steps = np.radians([imu.attitude_resolution_deg, imu.gyro_resolution_deg_s])
        self._alike = np.array(
            [
                _longest(tilt, steps[0], ATTITUDE_FROZEN_S * imu.rate_hz),
                _longest(gyro, steps[1], FROZEN_S * imu.rate_hz),
                _longest(force, imu.accelerometer_resolution_m_s2, FROZEN_S * imu.rate_hz),
            ]
        )
        self._period = to_nanoseconds(1.0 / imu.rate_hz)
        self._knock = KNOCK_S * imu.rate_hz
        self._usual = MEDIAN * self._noise
        self._quiet = QUIET * MEDIAN * np.array([gyro, force])
        none = np.zeros((5, 6))
        none[2] = self._usual
        self._now = Condition(none, np.zeros(3), np.zeros(4), np.zeros(3), np.full(2, -np.inf))

    def copied(self) -> Condition:
        """What is known by now."""
        return Condition(*(each.copy() for each in self._now))

    def back_to(self, before: Condition) -> None:
        """Forget what has come since then."""
        self._now = before

    def plain(self, samples: Sequence[ImuSample], begin: int, end: int) -> tuple[int, ...]:
        """Stamps of the samples if each may be used as it is: the usual case, in one call.

        Else nothing is taken in, and `judged` has to say of each what is to be made of it.

        Args:
            samples: checked.
            begin, end: ns, between which their stamps must be, one after the other.
        """
        stamps, rows = packed(samples)
        before = self.copied()
        if are_plain(
            *self._now, self._usual, self._quiet, stamps, rows, self._period, self._alike,
            *(self._least, self._most, begin, end),
        ):  # fmt: skip
            return tuple(sample.stamp for sample in samples)
        self.back_to(before)
        return ()

    def judged(self, name: str, sample: ImuSample) -> ImuSample:
        """A sample as it may be used: with its noise, without an attitude that is none.

        Raises:
            SignalError: it is no measurement.
        """
        rate, force = sample.angular_velocity, sample.linear_acceleration
        turns, pulls = float(np.abs(rate).max()), float(np.abs(force).max())
        if turns > RATE_RAD_S:
            raise SignalError(
                f"{name}.angular_velocity has {turns:.3g} rad/s; a vehicle turns by"
                f" {RATE_RAD_S:g} rad/s at most"
            )
        size = sqrt(float(force.dot(force))) if pulls < self._most else pulls
        if not self._least <= size <= self._most:
            raise SignalError(
                f"{name}.linear_acceleration has {size:.3g} m/s^2; it must be the specific force,"
                f" {self._least:.3g} to {self._most:.3g} m/s^2 under water, with gravity"
            )
        readings = sample.quaternion, rate, force
        follow(*self._now, self._usual, self._quiet, sample.stamp, *readings, self._period)
        for part in (RATE, FORCE):
            if self._is_frozen(part):
                raise SignalError(
                    f"{name}.{PARTS[part]} has been the same to the last bit for"
                    f" {self._now.same[part]:.0f} samples: it is no measurement"
                )
        if sample.oriented and self.attitude_is_frozen:
            sample = replace(sample, oriented=False)
        return self._with_noise(sample) if self._now.seen[2] > self._knock else sample

    @property
    def attitude_is_frozen(self) -> bool:
        """Whether the attitude has been the same for too long."""
        return self._is_frozen(ATTITUDE)

    def _is_frozen(self, part: int) -> bool:
        seen = self._now.seen[max(part - 1, 0)]
        return bool(seen > SEEN and self._now.same[part] > self._alike[part])

    def _with_noise(self, sample: ImuSample) -> ImuSample:
        """The sample with the noise that it has, where that is beyond the vehicle file.

        In powers of two, so that it seldom changes.
        """
        times = self._now.values[2] / self._usual
        rough = times > ROUGH
        std = np.where(rough, self._noise * 2.0 ** np.round(np.log2(times)), 0.0)
        std = std * np.sqrt(self._now.values[4])
        _, rate, force = self._known
        return replace(
            sample,
            angular_velocity_covariance=_raised(sample.angular_velocity_covariance, std[:3], rate),
            linear_acceleration_covariance=_raised(
                sample.linear_acceleration_covariance, std[3:], force
            ),
        )


def _raised(stated: Array, std: Array, known: tuple[float, float, float]) -> Array:
    """A covariance (3, 3) with variances that are at least these beyond what is known."""
    own = np.square(std) + np.where(std > 0.0, known, 0.0)
    return np.diag(np.fmax(stated.diagonal(), own))


def _longest(std: float, step: float, least: float) -> float:
    """Samples of three values that may be the same in a row."""
    alike = most_alike(std, step, 3)
    return np.inf if alike is None else float(max(alike, ceil(least)))


@exact_kernel
def follow(
    values: Array,
    seen: Array,
    attitude: Array,
    same: Array,
    times: Array,
    usual: Array,
    quiet: Array,
    stamp: float,
    quaternion: Array,
    rate: Array,
    force: Array,
    period: float,
) -> float:
    """Take a sample into a `Condition`; returns the largest median of |d| over the usual one.

    Args:
        values, seen, attitude, same, times: the condition.
        usual: (6,) median of |d| by the noise of the vehicle file, below which none falls.
        quiet: (2,) |d| that are noise, of rates and of forces.
        stamp: ns.
        quaternion, rate, force: the sample.
        period: ns, between two.
    """
    alike = True
    for i in range(4):
        alike = alike and quaternion[i] == attitude[i]
        attitude[i] = quaternion[i]
    same[0] = same[0] + 1.0 if alike else 1.0
    for part in range(2):
        alike = True
        for i in range(3):
            alike = alike and values[0, 3 * part + i] == (rate[i] if part == 0 else force[i])
        same[1 + part] = same[1 + part] + 1.0 if alike else 1.0
    dt, before = stamp - times[0], times[0] - times[1]
    even = abs(dt - before) < 0.25 * dt and dt < 4.0 * period
    most = 0.0
    for i in range(6):
        value = rate[i] if i < 3 else force[i - 3]
        if even:
            d = abs(value - 2.0 * values[0, i] + values[1, i])
            part = i // 3
            seen[part] += 1.0 if d > quiet[part] > 0.0 else 0.0
            values[3, i] = values[3, i] + 1.0 if d > FAR * values[2, i] else 0.0
            leaps = values[3, i] >= ROW
            values[4, i] = values[3, i] if leaps else 1.0
            up = LEAP if leaps else STEP
            values[2, i] *= up if d > values[2, i] else 1.0 / STEP
            values[2, i] = max(values[2, i], usual[i])
        values[1, i], values[0, i] = values[0, i], value
        most = max(most, values[2, i] / usual[i])
    times[1], times[0] = times[0], stamp
    seen[2] = seen[2] + 1.0 if most > ROUGH else 0.0
    return most


@exact_kernel
def are_plain(
    values: Array,
    seen: Array,
    attitude: Array,
    same: Array,
    times: Array,
    usual: Array,
    quiet: Array,
    stamps: Array,
    rows: Array,
    period: float,
    alike: Array,
    least: float,
    most: float,
    begin: int,
    end: int,
) -> bool:
    """Take samples into a `Condition` up to the first of which there is something to say.

    Args:
        values, seen, attitude, same, times, usual, quiet, period: as of `follow`.
        stamps, rows: as of `packed`.
        alike: (3,) samples in a row that may be the same: attitude, rate, force.
        least, most: m/s^2, of the size of the force.
        begin, end: ns, of the stamps.

    Returns:
        Whether there is none.
    """
    for k in range(len(stamps)):
        if not begin <= stamps[k] <= end:
            return False
        begin = stamps[k] + 1
        quaternion, rate, force = rows[k, :4], rows[k, 4:7], rows[k, 7:]
        size = sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
        if not least <= size <= most or np.abs(rate).max() > RATE_RAD_S:
            return False
        condition = values, seen, attitude, same, times
        if follow(*condition, usual, quiet, stamps[k], quaternion, rate, force, period) > ROUGH:
            return False
        for part in range(3):
            if seen[max(part - 1, 0)] > SEEN and same[part] > alike[part]:
                return False
    return True
