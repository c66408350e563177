"""The filter proper: a state at a time, which samples carry forward and correct, one by one."""

from collections.abc import Mapping
from copy import copy
from functools import partial

import numpy as np

from uvms_core.sensors import INERTIAL
from uvms_core.signals import Array, ImuSample, Odometry, to_seconds
from uvms_observer.navigation.alignment import aligned
from uvms_observer.navigation.innovation_gate import InnovationGate, Tally
from uvms_observer.navigation.installation import Installation
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.output import odometry
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.samples import Reading
from uvms_observer.navigation.state import NavigationState, empty_state


class Estimator:
    """State, covariance and gates; readings must come in the order of their stamps.

    Args:
        imu: the inertial unit.
        measurements: of all sensors, by name; the gyrocompass of the inertial unit is one of them.
        config: start and gates.
    """

    def __init__(
        self, imu: Installation, measurements: Mapping[str, Measurement], config: NavigationConfig
    ) -> None:
        self._imu = imu
        self._measurements = measurements
        self._config = config
        self._gates = {
            name: InnovationGate(each.size, config.gate_probability, config.gate_timeout_s)
            for name, each in measurements.items()
        }
        self.tallies = dict.fromkeys(measurements, Tally())
        self.state: NavigationState = empty_state()
        self.time: int | None = None  # ns; None until the first IMU sample
        self.start: Odometry | None = None  # where to begin; None: as configured
        self._rate = np.zeros(3)  # readings of the last IMU sample
        self._force = np.zeros(3)

    def copied(self) -> "Estimator":
        """An estimator that goes on alone from here."""
        other = copy(self)
        other.state = self.state.copied()
        other.tallies = dict(self.tallies)
        return other

    def take(self, reading: Reading) -> None:
        """Go to the reading's stamp and use it; before the first IMU sample others are ignored."""
        inertial = reading.name == INERTIAL.name
        if self.time is None:
            if inertial:
                self._align(reading.sample)
        elif inertial:
            self._carry(reading.sample)
            self._correct(reading)
        elif self._measurements[reading.name].usable(reading.sample):
            self.advance(reading.stamp)
            self._correct(reading)

    def advance(self, stamp: int) -> None:
        """Carry the state to the stamp with the last inertial readings."""
        self._propagate(stamp, self._rate, self._force)

    def odometry(self) -> Odometry:
        """The estimate at the body origin, at the present time."""
        imu = self._imu
        return odometry(self.time or 0, self.state, imu.body, self._rate, imu.rate_variance)

    def _align(self, sample: ImuSample) -> None:
        self.state = aligned(sample, self._imu, self._config, self.start)
        for each in self._measurements.values():
            for index, variance in each.initial_variance.items():
                self.state.covariance[index, index] = variance
        self.time = sample.stamp
        self._rate, self._force = sample.angular_velocity, sample.linear_acceleration

    def _carry(self, sample: ImuSample) -> None:
        """With the readings at both ends of the interval: second order in its length."""
        rate, force = sample.angular_velocity, sample.linear_acceleration
        self._propagate(sample.stamp, rate, force)
        self._rate, self._force = rate, force

    def _propagate(self, stamp: int, rate: Array, force: Array) -> None:
        """To the stamp, at which the inertial unit reads this."""
        if self.time is None or stamp <= self.time:
            return
        dt, self.time, imu = to_seconds(stamp - self.time), stamp, self._imu
        readings = self._rate, rate, self._force, force
        propagate(tuple(self.state), *readings, dt, imu.gravity, *imu.process)

    def _correct(self, reading: Reading) -> None:
        name = reading.name
        update = self._measurements[name].correct
        correct = partial(update, self.state, reading.sample, self._rate)
        gate, tally = self._gates[name], self.tallies[name]
        self.tallies[name] = gate.apply(tally, reading.stamp, correct, self._widen)

    def _widen(self, factor: float) -> None:
        self.state.covariance[:] *= factor
