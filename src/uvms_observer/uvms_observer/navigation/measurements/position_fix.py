"""A position fix under water."""

import numpy as np

from uvms_core.sensors.position_fix import FixSample, PositionFix
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.position import correct_position
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState


class FixPosition(Measurement):
    """p + R d + n, with the noise that the message states, or that of the vehicle file."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: PositionFix, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        vertical = section.vertical_noise_m or section.noise_m
        self._variance = np.array([section.noise_m, section.noise_m, vertical]) ** 2
        self._least = config.noise_floor.fix_m**2
        self._section = section

    def out_of_reach(self, state: NavigationState) -> str:
        """As `Measurement.out_of_reach`."""
        source, most = self._section.source_m, self._section.max_range_m
        if source is None or most is None:
            return ""
        away = float(np.linalg.norm(self.place(state) - source))
        return "out of range" if away > most else ""

    def correct(self, state: NavigationState, sample: FixSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        stated = np.diagonal(sample.covariance)
        variance = stated if (stated > 0.0).all() else self._variance
        variance = np.maximum(variance, self._least)
        return correct_position(state, sample.position, variance, self.lever, gate)
