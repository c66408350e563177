"""The filter proper: a state at a time, which samples carry forward and correct, one by one."""

from collections.abc import Callable
from copy import copy
from functools import partial
from typing import Any

import numpy as np

from uvms_core.geodesy import geodetic_to_ned
from uvms_core.signals import (
    Array,
    DvlSample,
    GpsSample,
    ImuSample,
    Odometry,
    PressureSample,
    to_seconds,
)
from uvms_observer.navigation import updates
from uvms_observer.navigation.alignment import aligned
from uvms_observer.navigation.innovation_gate import InnovationGate, Tally
from uvms_observer.navigation.installation import Installation
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.output import odometry
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.samples import NAMES, Sample
from uvms_observer.navigation.state import NavigationState, empty_state

_SIZES = {"imu": 3, "dvl": 3, "pressure": 1, "gps": 3}


class Estimator:
    """State, covariance and gates; samples must come in the order of their stamps."""

    def __init__(self, sensors: Installation, config: NavigationConfig) -> None:
        self._sensors = sensors
        self._config = config
        self._gates = {
            name: InnovationGate(size, config.gate_probability, config.gate_timeout_s)
            for name, size in _SIZES.items()
        }
        self.tallies = dict.fromkeys(_SIZES, Tally())
        self.state: NavigationState = empty_state()
        self.time: int | None = None  # ns; None until the first IMU sample
        self._rate = np.zeros(3)  # readings of the last IMU sample
        self._force = np.zeros(3)

    def copied(self) -> "Estimator":
        """An estimator that goes on alone from here."""
        other = copy(self)
        other.state = self.state.copied()
        other.tallies = dict(self.tallies)
        return other

    def take(self, sample: Sample) -> None:
        """Go to the sample's stamp and take it in; before the first IMU sample pass others by."""
        if self.time is not None:
            _TAKE[type(sample)](self, sample)
        elif isinstance(sample, ImuSample):
            self.state = aligned(sample, self._sensors, self._config)
            self.time = sample.stamp
            self._rate, self._force = sample.angular_velocity, sample.linear_acceleration

    def advance(self, stamp: int) -> None:
        """Carry the state to the stamp with the last inertial readings."""
        self._propagate(stamp, self._rate, self._force)

    def odometry(self) -> Odometry:
        """The estimate at the body origin, at the present time."""
        sensors = self._sensors
        return odometry(self.time or 0, self.state, sensors.body, self._rate, sensors.rate_variance)

    def _propagate(self, stamp: int, rate: Array, force: Array) -> None:
        if self.time is None or stamp <= self.time:
            return
        dt, self.time = to_seconds(stamp - self.time), stamp
        propagate(self.state, rate, force, dt, self._sensors.gravity, self._sensors.process)

    def _take_imu(self, sample: ImuSample) -> None:
        """Mean of the readings at both ends of the interval: second order in its length."""
        rate, force = sample.angular_velocity, sample.linear_acceleration
        self._propagate(sample.stamp, 0.5 * (self._rate + rate), 0.5 * (self._force + force))
        self._rate, self._force = rate, force
        variance = self._sensors.attitude_variance
        self._correct(sample, updates.correct_attitude, sample.quaternion, variance)

    def _take_dvl(self, sample: DvlSample) -> None:
        self.advance(sample.stamp)
        sensors = self._sensors
        gyro = (sensors.dvl, self._rate, sensors.rate_variance)
        variance = sensors.velocity_variance
        self._correct(sample, updates.correct_velocity, sample.velocity, variance, *gyro)

    def _take_pressure(self, sample: PressureSample) -> None:
        self.advance(sample.stamp)
        sensors = self._sensors
        depth = (sample.pressure - sensors.surface_pressure) / sensors.pressure_gradient
        mounted = (sensors.depth_variance, sensors.pressure)
        self._correct(sample, updates.correct_depth, depth, *mounted)

    def _take_gps(self, sample: GpsSample) -> None:
        if not sample.fix:
            return
        self.advance(sample.stamp)
        sensors = self._sensors
        place = (sample.latitude_deg, sample.longitude_deg, sample.altitude)
        antenna = geodetic_to_ned(*place, *sensors.datum)
        mounted = (sensors.position_variance, sensors.gps)
        self._correct(sample, updates.correct_position, antenna, *mounted)

    def _correct(self, sample: Sample, update: Callable[..., float], *arguments: Any) -> None:
        name = NAMES[type(sample)]
        correct = partial(update, self.state, *arguments)
        gate, tally = self._gates[name], self.tallies[name]
        self.tallies[name] = gate.apply(tally, sample.stamp, correct, self._widen)

    def _widen(self, factor: float) -> None:
        self.state.covariance[:] *= factor


_TAKE: dict[type, Callable[[Estimator, Any], None]] = {
    ImuSample: Estimator._take_imu,
    DvlSample: Estimator._take_dvl,
    PressureSample: Estimator._take_pressure,
    GpsSample: Estimator._take_gps,
}
