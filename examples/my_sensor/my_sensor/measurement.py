"""How the navigation filter uses a fix: as the position of the transponder."""

import numpy as np

from my_sensor.model import Usbl, UsblFix
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation import (
    Measurement,
    NavigationConfig,
    NavigationState,
    correct_position,
)


class UsblPosition(Measurement):
    """p + R d + n."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: Usbl, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self._variance = np.full(3, max(section.noise_m, config.noise_floor.position_m) ** 2)

    def correct(self, state: NavigationState, sample: UsblFix, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        return correct_position(state, sample.position, self._variance, self.lever, gate)
