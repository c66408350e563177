"""A depth gauge that gives metres."""

from uvms_core.sensors.depth import Depth, DepthSample
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.noise import as_white
from uvms_observer.navigation.measurements.pressure import correct_level
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import NavigationState


class DepthGauge(Measurement):
    """(p + R d)_z + n, its bias as noise that lasts: the state is the pressure sensor's."""

    size = 1

    def __init__(self, vehicle: Vehicle, section: Depth, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self._known = section.noise_m**2 + section.bias_m**2
        self._variance = max(section.noise_m, config.noise_floor.depth_m) ** 2
        self._variance += as_white(section.bias_m, section.rate_hz)

    def correct(
        self, state: NavigationState, sample: DepthSample, rate: Array, gate: float
    ) -> float:
        """As `Measurement.correct`."""
        variance = self._variance + max(sample.variance - self._known, 0.0)
        return correct_level(tuple(state), sample.depth, variance, self.lever, gate)
