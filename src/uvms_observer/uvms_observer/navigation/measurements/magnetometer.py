"""A magnetometer: the heading in the Earth's field."""

import numpy as np

from uvms_core.rotations import quat_to_matrix
from uvms_core.sensors.magnetometer import MICROTESLA, MagneticSample, Magnetometer
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.measurements.course import correct_magnetic
from uvms_observer.navigation.measurements.heading import Course
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState


class MagneticHeading(Course):
    """R^T B + b + n, of which the angle about the vertical is used.

    Its inclination would say something of roll and pitch, but gravity says it far better.
    """

    def __init__(self, vehicle: Vehicle, section: Magnetometer, config: NavigationConfig) -> None:
        self._earth = np.array(vehicle.environment.magnetic_field_ut) * MICROTESLA
        self._horizontal = float(np.hypot(self._earth[0], self._earth[1]))
        super().__init__(vehicle, section, config)

    def errors(self, section: Magnetometer) -> tuple[float, float]:
        """Std of noise and bias as an angle, rad: over the horizontal part of the field."""
        size = self._horizontal / MICROTESLA
        return section.noise_ut / size, section.bias_ut / size

    def usable(self, sample: MagneticSample) -> bool:
        """Whether there is a field at all."""
        return bool(sample.field.any())

    def heading(self, sample: MagneticSample, level: Array) -> tuple[float, float]:
        """As `Measurement.heading`."""
        seen = quat_to_matrix(level) @ sample.field
        angle = np.arctan2(self._earth[1], self._earth[0]) - np.arctan2(seen[1], seen[0])
        return float(angle), self._angle_variance(sample)

    def _angle_variance(self, sample: MagneticSample) -> float:
        stated = max(sample.covariance[0, 0], sample.covariance[1, 1])
        return self.stated(float(stated) / self._horizontal**2)

    def correct(
        self, state: NavigationState, sample: MagneticSample, rate: Array, gate: float
    ) -> float:
        """As `Measurement.correct`."""
        variance, fields = self._angle_variance(sample), tuple(state)
        return correct_magnetic(fields, sample.field, self._earth, variance, self._biased, gate)
