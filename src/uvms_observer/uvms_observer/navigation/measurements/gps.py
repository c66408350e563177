"""The satellite receiver: position of its antenna, while that is above the water."""

import numpy as np

from uvms_core.geodesy import geodetic_to_ned
from uvms_core.signals import Array, GpsSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Gps
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.noise import with_stated
from uvms_observer.navigation.measurements.position import correct_position
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState


class GpsPosition(Measurement):
    """p + R d + n, in the map whose datum the vehicle file gives."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: Gps, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        sea, floor = vehicle.environment, config.noise_floor.position_m
        horizontal = max(section.horizontal_noise_m, floor)
        vertical = max(section.vertical_noise_m, floor)
        self._variance = np.array([horizontal, horizontal, vertical]) ** 2
        noise = section.horizontal_noise_m, section.horizontal_noise_m, section.vertical_noise_m
        x, y, z = np.square(noise).tolist()
        self._known = x, y, z
        self._datum = (sea.datum_latitude_deg, sea.datum_longitude_deg)

    def usable(self, sample: GpsSample) -> bool:
        """Whether the receiver has a fix."""
        return sample.fix

    def out_of_reach(self, state: NavigationState) -> str:
        """As `Measurement.out_of_reach`."""
        return "under water" if self.place(state)[2] > 0.0 else ""

    def correct(self, state: NavigationState, sample: GpsSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        place = (sample.latitude_deg, sample.longitude_deg, sample.altitude)
        antenna = geodetic_to_ned(*place, *self._datum)
        variance = with_stated(self._variance, sample.covariance, self._known)
        return correct_position(state, antenna, variance, self.lever, gate)
