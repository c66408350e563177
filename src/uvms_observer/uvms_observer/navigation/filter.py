"""The navigation filter, eq. (20): gyrocompass and IMU, DVL, pressure, GPS ... to Odometry."""

from collections import deque
from collections.abc import Container, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from uvms_core import checks
from uvms_core.diagnostics import Trouble
from uvms_core.errors import SignalError
from uvms_core.sensors import INERTIAL
from uvms_core.signals import (
    Allocation,
    DvlSample,
    GpsSample,
    ImuSample,
    Odometry,
    PressureSample,
    to_nanoseconds,
    to_seconds,
)
from uvms_core.vehicle import Vehicle
from uvms_observer.errors import NotAlignedError
from uvms_observer.navigation.begin.initialisation import lacking
from uvms_observer.navigation.begin.levelling import check_gravity
from uvms_observer.navigation.estimator import Estimator
from uvms_observer.navigation.inertial.condition import ConditionCheck
from uvms_observer.navigation.inertial.installation import installation
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.samples import Instruments, Reading, is_nearly_unit
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.time_line import Step, replayed, with_late
from uvms_observer.navigation.trust import consistency, suspicion
from uvms_observer.navigation.trust.sensor_health import (
    Health,
    excused,
    health_of,
    joined,
    trouble_of,
)
from uvms_observer.navigation.trust.sound import is_sound
from uvms_observer.navigation.trust.top_speed import is_impossible
from uvms_observer.navigation.trust.unit_trouble import UnitTrouble

SWEPT = to_nanoseconds(2.0)
"""How long an estimate has been wrong, at least, that has got a velocity no vehicle has."""


class NavigationFilter:
    """Error-state extended Kalman filter, eq. (20); derivation in docs/navigation.md.

    Inertial readings carry the state from stamp to stamp; every other reading corrects it at its
    own stamp, at the point where its sensor is mounted. Without a sensor's samples the covariance
    grows. A sample that comes late, but within the configured latency, is used at its own stamp:
    the filter goes back to the step before it and processes all samples since then again.

    Args:
        vehicle: sensors with lever arms and noise, water, datum of the map.
        config: start, gate, latency, factors on the noise; None: the defaults.
    """

    def __init__(self, vehicle: Vehicle, config: NavigationConfig | None = None) -> None:
        config = config or NavigationConfig()
        self._instruments = Instruments(vehicle, config)
        imu = installation(vehicle, config)
        self._speed = imu.speed
        self._estimator = Estimator(
            imu, self._instruments.measurements, config, self._instruments.periods
        )
        self._condition, self._unit_trouble = ConditionCheck(vehicle), UnitTrouble(vehicle)
        self._hull = imu.hull.motion
        self._last: Odometry | None = None
        self._imu, self._gravity = vehicle.sensors.imu, vehicle.environment.gravity_m_s2
        self._latency = to_nanoseconds(config.latency_s)
        self._memory = max(self._latency, suspicion.MEMORY)
        self._steps: deque[Step] = deque()
        self._next_trial = 0  # ns
        self._wait = suspicion.AGAIN  # ns, between two trials
        self._stamp = -1  # of the last step
        self._newest: dict[str, int] = {}  # stamp of the newest sample, by sensor
        self._initialised = config.start == "given"
        self._known_within = config.known_within_m, config.known_within_m_s
        self.rejected = 0
        self.late = 0
        self.corrected = 0
        self.normalized = 0
        self.resets = 0

    @property
    def state(self) -> NavigationState:
        """A copy of the state and its covariance."""
        return self._estimator.state.copied()

    def resume(self, estimate: Odometry) -> None:
        """Begin with this estimate instead of the configured position; before the first step.

        Its position and velocity are taken with their covariance, the attitude from the first IMU
        sample.
        """
        self._estimator.start = estimate
        self._initialised = True

    def inform(self, allocation: Allocation | None) -> None:
        """The thrusts commanded at the tick before, ahead of a step; None: not known."""
        self._hull.inform(allocation)

    def step(
        self,
        stamp: int,
        imu: Sequence[ImuSample],
        dvl: Sequence[DvlSample] = (),
        pressure: Sequence[PressureSample] = (),
        gps: Sequence[GpsSample] = (),
        **further: Sequence[Any],
    ) -> Odometry:
        """Use the samples since the last step, by their stamps; returns the estimate at `stamp`.

        Args:
            stamp: ns.
            imu, dvl, pressure, gps: samples of the built-in sensors.
            further: of the vehicle's other sensors, by name.

        Raises:
            SignalError: a stamp is out of order, a value is not finite or has a wrong shape. The
                filter is as it was before; `step_screened` leaves out such samples instead.
            NotAlignedError: no IMU sample has come yet.
        """
        groups = {"imu": imu, "dvl": dvl, "pressure": pressure, "gps": gps, **further}
        before = self._condition.copied()
        good, faults = self._screen(stamp, groups)
        if faults:
            self._condition.back_to(before)
            raise faults[0]
        return self._step(stamp, good)

    def step_screened(
        self, stamp: int, samples: Mapping[str, Sequence[Any]]
    ) -> tuple[Odometry, list[SignalError]]:
        """As `step`, with samples by sensor; those that are refused are left out.

        Returns:
            The estimate, and an error for each sample that was refused.

        Raises:
            SignalError: the stamp itself is not after the last step's, or a sensor is unknown.
            NotAlignedError: no IMU sample has come yet.
        """
        good, faults = self._screen(stamp, samples)
        return self._step(stamp, good, faults), faults

    def _screen(
        self, stamp: int, groups: Mapping[str, Sequence[Any]]
    ) -> tuple[list[Reading], list[SignalError]]:
        """The readings that are good, in order, and an error for each that is not."""
        checks.later("stamp", stamp, self._stamp, "the last step's")
        newest, good, faults = dict(self._newest), [], []
        readings = self._instruments.readings(groups)
        for samples in groups.values():
            checks.trust_good(samples)
        oldest, has_begun = self._oldest, self._estimator.time is not None
        plain = self._plain(groups.get(INERTIAL.name, ()), newest, stamp) if has_begun else ()
        for reading in readings:
            at, _, name, sample = reading
            is_due = max(newest.get(name, -1) + 1, oldest) <= at <= stamp
            try:
                if not (is_due and has_begun and checks.is_trusted(sample)):  # else it is good
                    reading = self._checked(reading, stamp, newest)
                if not (name == INERTIAL.name and at in plain):
                    reading = self._of_a_vehicle(reading)
            except SignalError as fault:
                faults.append(fault)
                continue
            newest[name] = at
            good.append(reading)
        self.rejected += len(faults)
        return good, faults

    def _plain(
        self, samples: Sequence[ImuSample], newest: Mapping[str, int], stamp: int
    ) -> Container[int]:
        """Stamps of the unit's samples in which there is nothing to be judged one by one."""
        if not samples or not all(map(checks.is_trusted, samples)):
            return ()
        begin = max(newest.get(INERTIAL.name, -1) + 1, self._oldest)
        return self._condition.plain(samples, begin, stamp)

    def _checked(self, reading: Reading, stamp: int, newest: dict[str, int]) -> Reading:
        """A reading that is good, its quaternion of unit length; else SignalError."""
        self._check_stamp(reading, stamp, newest)
        self._check_start(reading)
        reading = self._of_unit_length(reading)
        checks.check(reading.name, reading.sample)
        return reading

    @property
    def _oldest(self) -> int:
        """Stamp of the oldest sample that can be used, ns."""
        return self._stamp - self._latency

    def _check_start(self, reading: Reading) -> None:
        """An inertial unit that starts must feel gravity the right way round."""
        if self._estimator.time is None and reading.name == INERTIAL.name:
            check_gravity(reading.name, self._imu, reading.sample, self._gravity)

    def _of_unit_length(self, reading: Reading) -> Reading:
        """Some drivers round their quaternions; what is nearly a rotation is taken as one."""
        if reading.name != INERTIAL.name or not is_nearly_unit(reading.sample.quaternion):
            return reading
        self.normalized += 1
        unit = reading.sample.quaternion / np.linalg.norm(reading.sample.quaternion)
        return reading._replace(sample=replace(reading.sample, quaternion=unit))

    def _of_a_vehicle(self, reading: Reading) -> Reading:
        """A reading that a vehicle under water may give, and as noisy as it is."""
        if reading.name == INERTIAL.name:
            return reading._replace(sample=self._condition.judged(reading.name, reading.sample))
        if fault := self._instruments.measurements[reading.name].fault(reading.sample):
            raise SignalError(f"{reading.name}.{fault}")
        return reading

    def _step(
        self, stamp: int, readings: list[Reading], faults: Sequence[SignalError] = ()
    ) -> Odometry:
        if self._estimator.time is None:
            self._estimator.look_for_heading(readings)
            if not self._estimator.can_begin(readings):
                raise NotAlignedError(_not_aligned(readings, faults))
        for reading in readings:
            self._newest[reading.name] = reading.stamp
        self._stamp = stamp
        if self._last is not None:
            self._hull.note(stamp, self._last)
        self._run(stamp, readings)
        self._last = self._estimator.odometry()
        return self._last

    def waits_for(self) -> str:
        """What the filter still waits for before its estimate means anything; empty: nothing."""
        if self._initialised:
            return ""
        lacks = lacking(self._estimator.state, *self._known_within)
        self._initialised = not lacks
        return lacks

    def health(self) -> dict[str, Health]:
        """How each sensor is doing at the last step."""
        return {
            name: excused(
                health_of(
                    tally,
                    to_seconds(self._stamp - self._newest.get(name, 0)),
                    self._instruments.periods[name],
                ),
                self._instruments.measurements[name],
                self._estimator.state,
            )
            for name, tally in self._estimator.tallies.items()
        }

    def mean_nis(self) -> dict[str, float]:
        """Normalized innovation squared of each sensor, over its dimension: 1 where all is right.

        The mean over the samples that were used; sensors without any are left out.
        """
        return {
            name: tally.distance / (tally.accepted * self._estimator.size_of(name))
            for name, tally in self._estimator.tallies.items()
            if tally.accepted
        }

    def trouble(self) -> Trouble | None:
        """Which sensors are not used, and why; whether the estimate is as good as it says."""
        return joined(
            trouble_of(self.health()),
            consistency.trouble_of(self._estimator.inconsistent(), self.resets),
            self._unit_trouble(self._estimator.state, self._condition.attitude_is_frozen),
        )

    def status(self) -> dict[str, int | float | str]:
        """Counters for diagnostics, the uncertainty (std) of the position in m, what is missing."""
        counts: dict[str, int | float | str] = {"refused": self.rejected, "late": self.late}
        for name, tally in self._estimator.tallies.items():
            counts[f"{name}_accepted"] = tally.accepted
            counts[f"{name}_gated"] = tally.gated
            counts[f"{name}_level"] = round(tally.level, 2)
        counts["imu_held_back"], counts["imu_normalized"] = self._estimator.held, self.normalized
        counts["corrected"], counts["resets"] = self.corrected, self.resets
        variance = np.trace(self._estimator.state.covariance[:3, :3])
        counts["position_std_m"] = float(np.sqrt(variance))
        if self._instruments.absent:
            counts["not_mounted"] = ", ".join(self._instruments.absent)
        return counts

    def _check_stamp(self, reading: Reading, stamp: int, newest: dict[str, int]) -> None:
        last, oldest = newest.get(reading.name, -1), self._oldest
        if max(last + 1, oldest) <= reading.stamp <= stamp:
            return
        what = f"{reading.name}.stamp is {reading.stamp} ns; it must"
        if reading.stamp > stamp:
            raise SignalError(f"{what} not be after the step's, {stamp} ns")
        if reading.stamp <= last:
            raise SignalError(f"{what} be after the last one's, {last} ns")
        raise SignalError(f"{what} not be before the filter's time less latency, {oldest} ns")

    def _run(self, stamp: int, readings: list[Reading]) -> None:
        late = [reading for reading in readings if reading.stamp <= self._estimator_time]
        self.late += len(late)
        if late:
            self._go_back_for(late)
            readings = [reading for reading in readings if reading.stamp > self._estimator_time]
        steps, self._estimator = replayed(self._estimator, [(readings, stamp)])
        self._steps.extend(steps)
        self._question(stamp)
        self._reset_where_lost(stamp)
        while len(self._steps) > 1 and self._steps[1].begin < stamp - self._memory:
            self._steps.popleft()

    @property
    def _estimator_time(self) -> int:
        return -1 if self._estimator.time is None else self._estimator.time

    def _go_back_for(self, late: list[Reading]) -> None:
        """Take readings that came late at their own stamps, and repeat everything since."""
        if not self._steps:  # it has begun anew since then
            return
        again = [self._steps.pop()]
        while self._steps and again[0].begin >= late[0].stamp:
            again.insert(0, self._steps.pop())
        steps, self._estimator = replayed(again[0].before, with_late(again, late))
        self._steps.extend(steps)

    def _reset_where_lost(self, stamp: int) -> None:
        """Begin anew where the estimate cannot be right: nothing that is known explains it."""
        tallies, state = self._estimator.tallies, self._estimator.state
        since = consistency.given_up(tallies, stamp)
        if not is_sound(state):
            since = stamp
        elif is_impossible(state, self._speed):
            since = min(stamp - SWEPT, consistency.contradicted(tallies, stamp))
        if since is not None:
            self._estimator.restart(since)
            self._steps.clear()
            self.resets += 1

    def _question(self, stamp: int) -> None:
        """Whether the estimate is wrong, where a sensor is rejected."""
        if stamp < self._next_trial:
            return
        steps = list(self._steps)
        suspects = suspicion.suspects(steps, self._estimator, stamp)
        self._wait = min(2 * self._wait, suspicion.LONGEST) if suspects else suspicion.AGAIN
        self._next_trial = stamp + self._wait
        for suspect in suspects:
            found = suspicion.tried(steps, suspect, self._estimator)
            if found is not None:
                steps, self._estimator = found
                self._steps = deque(steps)
                self.corrected += 1
                self._wait = suspicion.AGAIN
                return


def _not_aligned(readings: Sequence[Reading], faults: Sequence[SignalError]) -> str:
    """Why the filter cannot start."""
    if faults:
        return f"navigation cannot start: {faults[0]}"
    if any(each.name == INERTIAL.name for each in readings):
        return "navigation cannot start: the imu gives no attitude, and no heading has come yet"
    return "navigation has had no IMU sample yet; it needs an attitude"
