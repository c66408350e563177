"""The filter proper: a state at a time, which samples carry forward and correct, one by one."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from uvms_core.sensors import INERTIAL
from uvms_core.signals import Array, ImuSample, Odometry, to_seconds
from uvms_observer.navigation.begin.first_state import first_state
from uvms_observer.navigation.begin.resume import LOST_DEPTH_M, LOST_M, LOST_SPEED_M_S, lost, placed
from uvms_observer.navigation.inertial.at_once import alike, packed, take_inertial
from uvms_observer.navigation.inertial.installation import Installation, Stated
from uvms_observer.navigation.inertial.made_up import make_up_for
from uvms_observer.navigation.inertial.screen import ScreenMemory, Trend, remember, still
from uvms_observer.navigation.inertial.unknown_motion import GAP, gap_spread, spread
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.imu import Gyrocompass
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.output import odometry
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import (
    INERTIAL_BIASES,
    POSITION,
    VELOCITY,
    NavigationState,
    empty_state,
)
from uvms_observer.navigation.trust.corrections import SETTLED, Corrections
from uvms_observer.navigation.trust.innovation_gate import Tally
from uvms_observer.navigation.trust.sound import is_sound

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


class Estimator:
    """State, covariance and gates; readings must come in the order of their stamps.

    Args:
        imu: the inertial unit.
        measurements: of all sensors, by name; the gyrocompass of the inertial unit is one of them.
        config: start and gates.
        periods: between two samples of each, s.
    """

    def __init__(
        self,
        imu: Installation,
        measurements: Mapping[str, Measurement],
        config: NavigationConfig,
        periods: Mapping[str, float],
    ) -> None:
        self._imu = imu
        compass = measurements[INERTIAL.name]
        self._compass = compass.variance if type(compass) is Gyrocompass else None
        self._measurements = measurements
        self._config = config
        known = imu.speed, imu.hull
        self._trust = Corrections(measurements, config.gate_probability, periods, *known)
        self.state: NavigationState = empty_state()
        self.time: int | None = None  # ns; None until the first IMU sample
        self.start: Odometry | None = None  # where to begin; None: as configured
        self._heading: Reading | None = None  # last one before the start
        self._rate = np.zeros(3)  # last readings of the IMU that are believed
        self._force = np.zeros(3)
        self._now = self._rate, self._force  # what it would read at the estimator's time
        self._inertial = 0  # ns, stamp of the last IMU sample
        self._sample: ImuSample | None = None  # that sample
        self._excess: Stated | None = None  # noise that the last sample of the IMU states
        self._stated = np.zeros(9)  # the same, of attitude, rates and forces by axis
        self._screen = imu.screen(0.0, 0.0)
        self._memory: ScreenMemory = remember(still(self._rate, self._force))
        self._before = self._rate, self._force, 1.0  # readings before the last, s between them

    def copied(self) -> "Estimator":
        """An estimator that goes on alone from here."""
        other = object.__new__(Estimator)  # `copy` takes ten times as long
        other.__dict__.update(self.__dict__)
        other.state = self.state.copied()
        other._trust = self._trust.copied()
        return other

    @property
    def tallies(self) -> dict[str, Tally]:
        """Counts of the samples of each sensor."""
        return self._trust.tallies

    def look_for_heading(self, readings: Iterable[Reading]) -> None:
        """Before the start: remember a heading, which an inertial unit without attitude needs."""
        for reading in readings:
            measurement = self._measurements[reading.name]
            if measurement.usable(reading.sample) and reading.name != INERTIAL.name:
                found = measurement.heading(reading.sample, LEVEL)
                self._heading = self._heading if found is None else reading

    def can_begin(self, readings: Iterable[Reading]) -> bool:
        """Whether an attitude follows from these readings, and a heading known by now."""
        return any(
            each.name == INERTIAL.name and (each.sample.oriented or self._heading is not None)
            for each in readings
        )

    def take(self, readings: Sequence[Reading]) -> None:
        """Go to the stamp of each reading and use it."""
        while readings:
            at_once = self._take_at_once(readings)
            if at_once:
                self.state = self._trust.bounded(self.state, self.time or 0)
            else:
                self._take(readings[0])
            readings = readings[at_once or 1 :]

    def _take(self, reading: Reading) -> None:
        """One reading in any case; before the first IMU sample others are ignored."""
        inertial = reading.name == INERTIAL.name
        if self.time is None:
            if inertial:
                self._align(reading.sample)
        elif inertial:
            self._carry(reading.sample)
            self.state = self._trust.bounded(self.state, self.time)
            if self._measurements[reading.name].usable(reading.sample):
                self.state = self._trust.correct(self.state, reading, self._now[0])
        elif self._measurements[reading.name].usable(reading.sample):
            self.advance(reading.stamp)
            needs_rate = self._measurements[reading.name].needs_rate
            if not needs_rate or self._screen.knows_rate(self._memory):
                self.state = self._trust.correct(self.state, reading, self._now[0])

    def advance(self, stamp: int) -> None:
        """Carry the state to the stamp with what the inertial unit would read there."""
        if self.time is None or stamp <= self.time:
            return
        rate, force = self._rate, self._force
        if not self._memory.row:
            rate, force = self._screen.ahead(self._trend(), to_seconds(stamp - self._inertial))
        self._propagate(stamp, rate, force)
        if stamp - self._inertial > SETTLED:  # the unit is silent
            self.state = self._trust.bounded(self.state, stamp)

    def odometry(self) -> Odometry:
        """The estimate at the body origin, at the present time."""
        imu, state = self._imu, self._trust.widened(self.state, self.time or 0)
        return odometry(self.time or 0, state, imu.body, self._now[0], imu.rate_variance)

    def _align(self, sample: ImuSample) -> None:
        given = self._measurements, self._imu, self._config, self.start
        begun = first_state(sample, self._heading, *given)
        if begun is None:
            return
        self.state, sample = begun
        self._excess = None  # the state is new
        self._listen(self._imu.excess_of(sample))
        self.time = self._inertial = sample.stamp
        self._sample = sample
        self._now = self._rate, self._force = sample.angular_velocity, sample.linear_acceleration
        self._memory = remember(still(self._rate, self._force))
        self._before = self._rate, self._force, 1.0

    def _take_at_once(self, readings: Sequence[Reading]) -> int:
        """Carry and correct by the first readings where they are the unit's and usual; how many."""
        name, trust, imu = INERTIAL.name, self._trust, self._imu
        if self._compass is None or self.time is None or self._memory.row:
            return 0
        samples, excess = alike(readings, name, imu.excess_of)
        if excess is None or trust.tallies[name].row:
            return 0
        self._listen(excess)
        gate, tally = trust.gates[name], trust.tallies[name]
        taken, fits, *running = take_inertial(
            tuple(self.state),
            *packed(samples),
            *(self.time, self._inertial, *self._now, *self._screen.allowance),
            *(imu.gravity, *imu.process, self._compass + self._stated[:3], gate.limit),
            *(tally.distance, tally.level, tally.mean, *gate.weights),
        )
        if not taken:
            return 0
        self._remember(samples[:taken])
        if count := taken if fits else taken - 1:
            trust.accept(name, samples[count - 1].stamp, count, *running)
        if not fits:
            self.state = trust.reject(self.state, readings[taken - 1], self._now[0])
        return int(taken)

    def _listen(self, excess: Stated) -> None:
        """Take the unit to be as noisy as a sample says, until the next one."""
        if excess != self._excess:
            _, rate, force = self._excess = excess
            self._stated = np.ravel(excess)
            if self._stated[3:].any():  # samples before these may have been as noisy
                self._trust.unusual = self.time or 0
            self.state.excess[:] = self._stated[3:]
            self._screen = self._imu.screen(max(rate), max(force))

    def _remember(self, samples: Sequence[ImuSample]) -> None:
        """The readings of the unit after samples that are believed."""
        for sample in samples[-2:]:
            self._before = self._rate, self._force, to_seconds(sample.stamp - self._inertial)
            self._rate, self._force = sample.angular_velocity, sample.linear_acceleration
            self._inertial, self._sample = sample.stamp, sample
        self._now = self._rate, self._force
        self.time = max(self.time or 0, self._inertial)

    def _carry(self, sample: ImuSample) -> None:
        """With the readings at both ends of the interval: second order in its length."""
        self._listen(self._imu.excess_of(sample))
        dt = to_seconds(sample.stamp - self._inertial)
        if not self._memory.row:
            self._memory = remember(self._trend(), self._memory.held)
        screened, self._memory = self._screen.judge(
            self._memory, sample.angular_velocity, sample.linear_acceleration, dt
        )
        if screened.turn is not None:
            self._trust.unusual = sample.stamp
        if screened.jump is not None:
            self._now = screened.jump.before.rate, screened.jump.before.force
        self._propagate(sample.stamp, screened.rate, screened.force)
        self._rate, self._force, self._inertial = screened.rate, screened.force, sample.stamp
        self._sample = sample
        if screened.turn is not None and screened.change is not None:
            spread(tuple(self.state), screened.turn, screened.change, dt)
        if screened.jump is not None:
            make_up_for(self.state, screened.jump, dt)

    def _trend(self) -> Trend:
        """The last reading that is believed, and how fast it changes."""
        if self._memory.good.rate is self._rate:
            return self._memory.good
        rate, force, gone = self._before  # the last one was taken at once
        return still(rate, force).to(self._rate, self._force, gone)

    def _propagate(self, stamp: int, rate: Array, force: Array) -> None:
        """To the stamp, at which the inertial unit reads this."""
        if self.time is None or stamp <= self.time:
            return
        begin, self.time, imu = self.time, stamp, self._imu
        dt = to_seconds(stamp - begin)
        (rate_now, force_now), self._now = self._now, (rate, force)
        readings = rate_now, rate, force_now, force
        propagate(tuple(self.state), *readings, dt, imu.gravity, *imu.process)
        if (gone := to_seconds(stamp - self._inertial)) > GAP * imu.period:
            unknown = gap_spread(to_seconds(begin - self._inertial), gone, imu.gravity)
            spread(tuple(self.state), *unknown, dt)

    def inconsistent(self) -> dict[str, float]:
        """How far beyond chance the levels of sensors are, as a factor; of those that are."""
        return self._trust.inconsistent()

    def restart(self, since: int) -> None:
        """Give up what has been wrong since then (ns), and begin with the last inertial sample.

        The position is still known as far as the vehicle cannot have moved since.
        """
        now = self.time or 0
        self.start = lost(now, np.array(self._config.initial_position_m))
        if is_sound(self.state):
            self.start = placed(self.start, self.odometry(), to_seconds(now - since))
        self._trust.restart()
        if self._sample is not None:
            self._align(self._sample)
            self.advance(now)

    def doubt_imu(self, times: float = 1.0) -> None:
        """Take the inertial biases to be unknown from now on, by so many times the usual fault."""
        P = self.state.covariance
        P[INERTIAL_BIASES, INERTIAL_BIASES] += times**2 * np.diag(self._imu.faulty_bias_variance)

    def doubt_velocity(self) -> None:
        """Take the velocity to be unknown now: no sensor has jumped, the estimate was wrong."""
        P = self.state.covariance
        P[VELOCITY, VELOCITY] += np.eye(3) * LOST_SPEED_M_S**2
        self.state = self._trust.without_jumps(self.state, self.tallies)

    def doubt_place(self) -> None:
        """Take position and velocity to be unknown now."""
        self.doubt_velocity()
        P = self.state.covariance
        P[POSITION, POSITION] += np.diag(np.square([LOST_M, LOST_M, LOST_DEPTH_M]))

    def misfit_of(self, name: str) -> float:
        """How badly it fits that a sensor is off, by its changes: 0 on average where it is."""
        return self._trust.misfit_of(name)

    def size_of(self, name: str) -> int:
        """Dimension of a sensor's measurement."""
        return self._measurements[name].size

    @property
    def held(self) -> int:
        """Inertial readings that were held back as spikes."""
        return self._memory.held
