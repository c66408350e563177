"""The filter proper: a state at a time, which samples carry forward and correct, one by one."""

from collections.abc import Iterable, Mapping, Sequence
from copy import copy
from functools import partial

import numpy as np

from uvms_core.sensors import INERTIAL
from uvms_core.signals import Array, ImuSample, Odometry, to_nanoseconds, to_seconds
from uvms_observer.navigation.begin.first_state import first_state
from uvms_observer.navigation.begin.resume import LOST_DEPTH_M, LOST_M, LOST_SPEED_M_S, lost, placed
from uvms_observer.navigation.inertial.alike import alike
from uvms_observer.navigation.inertial.at_once import packed, take_inertial
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
from uvms_observer.navigation.trust import offsets, undecided
from uvms_observer.navigation.trust.innovation_gate import InnovationGate, Tally, accepted
from uvms_observer.navigation.trust.offsets import Offsets
from uvms_observer.navigation.trust.sound import is_sound
from uvms_observer.navigation.trust.stuck import Repeated, is_stuck
from uvms_observer.navigation.trust.undecided import Doubt

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
SETTLED = to_nanoseconds(1.0)
"""After an unusual reading of the inertial unit, before the estimate is itself again."""


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
        self._compass = compass if type(compass) is Gyrocompass else None
        self._measurements = measurements
        self._config = config
        self._gates = {
            name: InnovationGate(each.size, config.gate_probability, periods[name])
            for name, each in measurements.items()
        }
        self.tallies = dict.fromkeys(measurements, Tally())
        self._doubts: dict[str, Doubt] = {}  # of the sensors whose last sample was rejected
        self._offsets = Offsets()
        self._repeated: dict[str, Repeated] = {}  # last readings
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
        self._screen = imu.screen(0.0, 0.0)
        self._memory: ScreenMemory = remember(still(self._rate, self._force))
        self._before = self._rate, self._force, 1.0  # readings before the last, s between them
        self._unusual = -SETTLED  # ns, stamp of the last of them that was held back or unlikely

    def copied(self) -> "Estimator":
        """An estimator that goes on alone from here."""
        other = copy(self)
        other.state = self.state.copied()
        other.tallies = dict(self.tallies)
        other._doubts = dict(self._doubts)
        other._repeated = dict(self._repeated)
        return other

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
                self._bound_speed()
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
            self._bound_speed()
            if self._measurements[reading.name].usable(reading.sample):
                self._correct(reading)
        elif self._measurements[reading.name].usable(reading.sample):
            self.advance(reading.stamp)
            needs_rate = self._measurements[reading.name].needs_rate
            if not needs_rate or self._screen.knows_rate(self._memory):
                self._correct(reading)

    def advance(self, stamp: int) -> None:
        """Carry the state to the stamp with what the inertial unit would read there."""
        if self.time is None or stamp <= self.time:
            return
        rate, force = self._rate, self._force
        if not self._memory.row:
            rate, force = self._screen.ahead(self._trend(), to_seconds(stamp - self._inertial))
        self._propagate(stamp, rate, force)
        if stamp - self._inertial > SETTLED:  # the unit is silent
            self._bound_speed()

    def odometry(self) -> Odometry:
        """The estimate at the body origin, at the present time."""
        imu, state = self._imu, self.state
        wider = undecided.widened(state.covariance, self._doubts, self.tallies, self.time or 0)
        if wider is not None:
            state = state._replace(covariance=wider)
        if beyond := self.inconsistent():
            state = state._replace(covariance=max(beyond.values()) * state.covariance)
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
        compass = self._compass
        if compass is None or self.time is None or self._memory.row:
            return 0
        samples, excess = alike(readings, self._imu.excess_of)
        if excess is None or self.tallies[INERTIAL.name].row:
            return 0
        self._listen(excess)
        imu, gate, tally = self._imu, self._gates[INERTIAL.name], self.tallies[INERTIAL.name]
        taken, fits, *running = take_inertial(
            tuple(self.state),
            *packed(samples),
            *(self.time, self._inertial, *self._now, *self._screen.allowance),
            *(imu.gravity, *imu.process, compass.variance_of(samples[0]), gate.limit),
            *(tally.distance, tally.level, tally.mean, *gate.weights),
        )
        if not taken:
            return 0
        self._remember(samples[:taken])
        last = readings[taken - 1]
        count = taken if fits else taken - 1
        if count:
            used = samples[count - 1].stamp
            tally = self.tallies[INERTIAL.name] = accepted(tally, used, count, *running)
        if not fits:
            self._reject(last, gate.rejected(tally, last.stamp, self.state.innovation))
        return int(taken)

    def _listen(self, excess: Stated) -> None:
        """Take the unit to be as noisy as a sample says, until the next one."""
        if excess != self._excess:
            _, rate, force = self._excess = excess
            if any((*rate, *force)):  # samples before these may have been as noisy
                self._unusual = self.time or 0
            self.state.excess[:] = *rate, *force
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
            self._unusual = sample.stamp
        if screened.jump is not None:
            self._now = screened.jump.before.rate, screened.jump.before.force
        self._propagate(sample.stamp, screened.rate, screened.force)
        self._rate, self._force, self._inertial = screened.rate, screened.force, sample.stamp
        self._sample = sample
        if screened.turn is not None and screened.change is not None:
            spread(tuple(self.state), screened.turn, screened.change, dt)
        if screened.jump is not None:
            make_up_for(self.state, screened.jump, dt)

    def _bound_speed(self) -> None:
        """Where nothing tells the velocity, it is that of such a vehicle."""
        now = self._imu.speed, self.time or 0
        self.state, self._offsets = offsets.bound_speed(self.state, self._offsets, *now)

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
        shares = {name: each.level / self._gates[name].bound for name, each in self.tallies.items()}
        return {name: share for name, share in shares.items() if share > 1.0}

    def restart(self, since: int) -> None:
        """Give up what has been wrong since then (ns), and begin with the last inertial sample.

        The position is still known as far as the vehicle cannot have moved since.
        """
        now = self.time or 0
        self.start = lost(now, np.array(self._config.initial_position_m))
        if is_sound(self.state):
            self.start = placed(self.start, self.odometry(), to_seconds(now - since))
        self.tallies = {
            name: Tally(tally.accepted, tally.gated) for name, tally in self.tallies.items()
        }
        self._doubts, self._offsets = {}, Offsets()
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
        self._forget_jumps(self.tallies)

    def doubt_place(self) -> None:
        """Take position and velocity to be unknown now."""
        self.doubt_velocity()
        P = self.state.covariance
        P[POSITION, POSITION] += np.diag(np.square([LOST_M, LOST_M, LOST_DEPTH_M]))

    def misfit_of(self, name: str) -> float:
        """How badly it fits that a sensor is off, by its changes: 0 on average where it is."""
        kept = self._offsets.of(name)
        return np.inf if kept is None else kept.misfit

    def size_of(self, name: str) -> int:
        """Dimension of a sensor's measurement."""
        return self._measurements[name].size

    @property
    def held(self) -> int:
        """Inertial readings that were held back as spikes."""
        return self._memory.held

    def _correct(self, reading: Reading) -> None:
        name = reading.name
        if self._is_stuck(reading) or self._follow(reading):
            return
        update = self._measurements[name].correct
        correct = partial(update, self.state, reading.sample, self._now[0])
        tally = self._gates[name].apply(
            self.tallies[name], reading.stamp, correct, self.state.innovation
        )
        if tally.row:
            self._reject(reading, tally)
            self._begin_to_follow(reading)
        else:
            self.tallies[name] = tally
            self._doubts.pop(name, None)

    def _is_stuck(self, reading: Reading) -> bool:
        """Whether the sensor has read the same to the last bit too often; such a sample counts."""
        name = reading.name
        if not is_stuck(self._repeated, name, self._measurements[name], reading.sample):
            return False
        self.tallies[name] = self._gates[name].refused(self.tallies[name], reading.stamp)
        if self._offsets.of(name):
            self.state, self._offsets = offsets.silence(self.state, self._offsets)
        return True

    def _begin_to_follow(self, reading: Reading) -> None:
        """After a sample that was rejected: if the sensor has just jumped, use its changes."""
        sensor, tally = self._measurements[reading.name], self.tallies[reading.name]
        is_new = tally.row == 1 and tally.away is not None and tally.used is not None
        if is_new and sensor.follows:
            self.state, self._offsets = offsets.begin(
                self.state, self._offsets, reading, sensor, self._now[0]
            )

    def _follow(self, reading: Reading) -> bool:
        """Use a sample of a sensor that has jumped by its changes; False where it is right again.

        It still counts as rejected: the sensor is off.
        """
        name, stamp, tally = reading.name, reading.stamp, self.tallies[reading.name]
        if tally.away is None or not self._offsets.of(name):
            return False
        self.state, self._offsets, residual = offsets.follow(
            self.state, self._offsets, reading, self._measurements[name], self._now[0],
            self._imu.speed,
        )  # fmt: skip
        if self._offsets.sensor is None:
            self.tallies[name] = tally._replace(away=tally.away.back(residual))
            return False
        innovation = self.state.innovation
        self._reject(reading, self._gates[name].rejected(tally, stamp, innovation, tally.away))
        return True

    def _reject(self, reading: Reading, tally: Tally) -> None:
        """Keep the tally of a sample that is not used, and what it would have changed."""
        name, other = reading.name, undecided.believed(self.state)
        self._measurements[name].correct(other, reading.sample, self._now[0], np.inf)
        before, self.tallies[name] = self._doubts.get(name), tally
        self._doubts[name] = undecided.doubt(self.state, other, tally, before, reading.stamp)
        self._forget_jumps_of_its_own(reading.stamp)

    def _forget_jumps_of_its_own(self, stamp: int) -> None:
        """Where the estimate may have jumped, and not a sensor, no sensor has to jump back.

        That is so while the inertial unit reads what a vehicle hardly does, and where two sensors
        are away at once.
        """
        away = [name for name, tally in self.tallies.items() if tally.away is not None]
        if len(away) > 1 or stamp - self._unusual < SETTLED:
            self._forget_jumps(away)

    def _forget_jumps(self, names: Iterable[str]) -> None:
        """Let these sensors come back where they agree, without a jump back."""
        for name in tuple(names):
            self.tallies[name] = self.tallies[name]._replace(away=None)
            if self._offsets.of(name):
                self.state, self._offsets = offsets.stop(self.state, self._offsets)
