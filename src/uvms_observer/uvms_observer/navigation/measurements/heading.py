"""A heading, of a compass or another attitude sensor."""

from abc import abstractmethod
from typing import Any

import numpy as np

from uvms_core.rotations import quat_to_rpy
from uvms_core.sensors.heading import Heading, HeadingSample
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.begin.heading_reference import carries_the_heading
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.course import HEADING_BIAS, correct_heading
from uvms_observer.navigation.measurements.noise import as_white
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState


class Course(Measurement):
    """A sensor of the heading; its bias is a state where the inertial unit has no attitude."""

    size = 1

    def __init__(self, vehicle: Vehicle, section: Any, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        noise, bias = self.errors(section)
        self._known = noise**2 + bias**2
        self._variance = max(noise, np.radians(config.noise_floor.attitude_deg)) ** 2
        self._biased = carries_the_heading(vehicle, section)
        if self._biased:
            self.initial_variance = {HEADING_BIAS: bias**2}
        else:
            self._variance += as_white(bias, section.rate_hz)

    @abstractmethod
    def errors(self, section: Any) -> tuple[float, float]:
        """Std of noise and bias as an angle, rad."""

    def stated(self, variance: float) -> float:
        """Noise of a sample whose message states a variance, rad^2."""
        return self._variance + max(variance - self._known, 0.0)


class HeadingAngle(Course):
    """Heading + b + n."""

    def errors(self, section: Heading) -> tuple[float, float]:
        """Std of noise and bias, rad."""
        return float(np.radians(section.noise_deg)), float(np.radians(section.bias_deg))

    def heading(self, sample: HeadingSample, level: Array) -> tuple[float, float]:
        """As `Measurement.heading`."""
        return float(quat_to_rpy(sample.quaternion)[2]), self.stated(sample.covariance[2, 2])

    def correct(
        self, state: NavigationState, sample: HeadingSample, rate: Array, gate: float
    ) -> float:
        """As `Measurement.correct`."""
        angle, variance = self.heading(sample, state.quaternion)
        return correct_heading(tuple(state), angle, variance, self._biased, gate)
