"""Which samples correct the estimate, and what is kept of those that do not.

A sample within the gate of its sensor corrects. One beyond it does not; what it would have changed
is kept, for as long as it is open whether the sensor lies (`undecided.py`), and a sensor that has
just jumped is used by its changes (`offsets.py`).
"""

from collections.abc import Iterable, Mapping
from functools import partial

import numpy as np

from uvms_core.signals import Array, to_nanoseconds
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import NavigationState
from uvms_observer.navigation.trust import offsets, undecided
from uvms_observer.navigation.trust.hull_model import HullModel
from uvms_observer.navigation.trust.innovation_gate import InnovationGate, Tally, accepted
from uvms_observer.navigation.trust.offsets import Offsets
from uvms_observer.navigation.trust.stuck import Repeated, is_stuck
from uvms_observer.navigation.trust.undecided import Doubt

SETTLED = to_nanoseconds(1.0)
"""After an unusual reading of the inertial unit, before the estimate is itself again."""


class Corrections:
    """Gates, tallies and doubts of all sensors.

    The state that a method is given is changed in place, and returned where it may be another one.

    Args:
        measurements: of all sensors, by name.
        probability: share of good samples that a gate accepts.
        periods: between two samples of each, s.
        speed: std of the vehicle's velocity over ground, m/s.
        hull: what the thrusts make of it.
    """

    def __init__(
        self,
        measurements: Mapping[str, Measurement],
        probability: float,
        periods: Mapping[str, float],
        speed: float,
        hull: HullModel,
    ) -> None:
        self._measurements, self._speed, self._hull = measurements, speed, hull
        self.gates = {
            name: InnovationGate(each.size, probability, periods[name])
            for name, each in measurements.items()
        }
        self.tallies = dict.fromkeys(measurements, Tally())
        self._doubts: dict[str, Doubt] = {}  # of the sensors whose last sample was rejected
        self._offsets = Offsets()
        self._repeated: dict[str, Repeated] = {}  # last readings
        self.unusual = -SETTLED  # ns, stamp of the unit's last reading that was held back

    def copied(self) -> "Corrections":
        """The same, which go on alone from here."""
        other = object.__new__(Corrections)  # `copy` takes ten times as long
        other.__dict__.update(self.__dict__)
        other.tallies = self.tallies.copy()
        other._doubts = self._doubts.copy()
        other._repeated = self._repeated.copy()
        return other

    def correct(self, state: NavigationState, reading: Reading, rate: Array) -> NavigationState:
        """By a reading at the state's time, at the rate (3,) rad/s of the gyro."""
        name = reading.name
        measurement, gate, tally = self._measurements[name], self.gates[name], self.tallies[name]
        if is_stuck(self._repeated, name, measurement, reading.sample):
            return self._refuse(state, reading)
        if tally.away is not None and self._offsets.of(name):
            state, is_off = self._follow(state, reading, rate)
            if is_off:
                return state
            tally = self.tallies[name]
        update = partial(measurement.correct, state, reading.sample, rate)
        tally = gate.apply(tally, reading.stamp, update, state.innovation)
        if tally.row:
            state = self.reject(state, reading, rate, tally)
            return self._begin_to_follow(state, reading, rate)
        self.tallies[name] = tally
        self._doubts.pop(name, None)
        return state

    def accept(
        self, name: str, stamp: int, count: int, total: float, level: float, mean: Array
    ) -> None:
        """Count samples that have been used elsewhere; arguments as of `accepted`."""
        self.tallies[name] = accepted(self.tallies[name], stamp, count, total, level, mean)

    def reject(
        self, state: NavigationState, reading: Reading, rate: Array, tally: Tally | None = None
    ) -> NavigationState:
        """Keep the tally of a sample that is not used, and what it would have changed.

        Args:
            state, reading, rate: as of `correct`.
            tally: after it; None: the sample was beyond the gate.
        """
        name, other = reading.name, undecided.believed(state)
        if tally is None:
            before = self.tallies[name]
            tally = self.gates[name].rejected(before, reading.stamp, state.innovation)
        self._measurements[name].correct(other, reading.sample, rate, np.inf)
        doubt, self.tallies[name] = self._doubts.get(name), tally
        self._doubts[name] = undecided.doubt(state, other, tally, doubt, reading.stamp)
        return self._without_jumps_of_its_own(state, reading.stamp)

    def bounded(self, state: NavigationState, time: int) -> NavigationState:
        """Where nothing tells the velocity at `time`, ns, it is that of such a vehicle."""
        given = self._offsets, self._speed, self._hull
        state, self._offsets = offsets.bound_speed(state, *given, time)
        return state

    def widened(self, state: NavigationState, time: int) -> NavigationState:
        """The state as uncertain as it is with all that is open at `time`, ns."""
        wider = undecided.widened(state.covariance, self._doubts, self.tallies, time)
        if wider is not None:
            state = state._replace(covariance=wider)
        if beyond := self.inconsistent():
            state = state._replace(covariance=max(beyond.values()) * state.covariance)
        return state

    def inconsistent(self) -> dict[str, float]:
        """How far beyond chance the levels of sensors are, as a factor; of those that are."""
        gates = self.gates
        return {
            name: each.level / gates[name].bound
            for name, each in self.tallies.items()
            if each.level > gates[name].bound
        }

    def restart(self) -> None:
        """Forget all but how many samples were used."""
        self.tallies = {
            name: Tally(tally.accepted, tally.gated) for name, tally in self.tallies.items()
        }
        self._doubts, self._offsets = {}, Offsets()

    def without_jumps(self, state: NavigationState, names: Iterable[str]) -> NavigationState:
        """Let these sensors come back where they agree, without a jump back."""
        for name in tuple(names):
            self.tallies[name] = self.tallies[name]._replace(away=None)
            if self._offsets.of(name):
                state, self._offsets = offsets.stop(state, self._offsets)
        return state

    def misfit_of(self, name: str) -> float:
        """How badly it fits that a sensor is off, by its changes: 0 on average where it is."""
        kept = self._offsets.of(name)
        return np.inf if kept is None else kept.misfit

    def _refuse(self, state: NavigationState, reading: Reading) -> NavigationState:
        """After a sample that is the same to the last bit too often; such a sample counts."""
        name = reading.name
        self.tallies[name] = self.gates[name].refused(self.tallies[name], reading.stamp)
        if self._offsets.of(name):
            state, self._offsets = offsets.silence(state, self._offsets)
        return state

    def _begin_to_follow(
        self, state: NavigationState, reading: Reading, rate: Array
    ) -> NavigationState:
        """After a sample that was rejected: if the sensor has just jumped, use its changes."""
        sensor, tally = self._measurements[reading.name], self.tallies[reading.name]
        is_new = tally.row == 1 and tally.away is not None and tally.used is not None
        if is_new and sensor.follows:
            state, self._offsets = offsets.begin(state, self._offsets, reading, sensor, rate)
        return state

    def _follow(
        self, state: NavigationState, reading: Reading, rate: Array
    ) -> tuple[NavigationState, bool]:
        """Use a sample of a sensor that has jumped by its changes; whether the sensor is off still.

        Such a sample counts as rejected.
        """
        name, tally = reading.name, self.tallies[reading.name]
        state, self._offsets, residual = offsets.follow(
            state, self._offsets, reading, self._measurements[name], rate, self._speed
        )
        if self._offsets.sensor is None:
            away = None if tally.away is None else tally.away.back(residual)
            self.tallies[name] = tally._replace(away=away)
            return state, False
        tally = self.gates[name].rejected(tally, reading.stamp, state.innovation, tally.away)
        return self.reject(state, reading, rate, tally), True

    def _without_jumps_of_its_own(self, state: NavigationState, stamp: int) -> NavigationState:
        """Where the estimate may have jumped, and not a sensor, no sensor has to jump back.

        That is so while the inertial unit reads what a vehicle hardly does, and where two sensors
        are away at once.
        """
        away = [name for name, tally in self.tallies.items() if tally.away is not None]
        if len(away) > 1 or stamp - self.unusual < SETTLED:
            return self.without_jumps(state, away)
        return state
