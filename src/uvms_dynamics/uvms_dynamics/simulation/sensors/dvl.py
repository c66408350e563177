"""Doppler velocity log."""

import numpy as np

from uvms_core.sensors import dvl
from uvms_core.signals import Array, DvlSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import SPEED, Trajectory


class DvlSensor(SensorModel):
    """Velocity over ground at the lever arm, body axes: (1 + s) (v + omega x r) + noise."""

    type = dvl.TYPE

    def __init__(self, vehicle: Vehicle, section: Dvl, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._dvl = section
        self._lever = np.array(section.position_m)
        self._scale = 1.0 + section.scale_error * self.rng.standard_normal()

    def sample(self, trajectory: Trajectory) -> tuple[DvlSample, ...]:
        """Samples that are due on the trajectory."""
        rows = trajectory.due(self.period)
        if not rows:
            return ()
        motion = trajectory.at_lever(rows, self._lever, 0.0)
        return tuple(
            self._read(trajectory.stamps[row], motion[k, SPEED]) for k, row in enumerate(rows)
        )

    def _read(self, stamp: int, velocity: Array) -> DvlSample:
        noise = self._dvl.noise_m_s * self.rng.standard_normal(3)
        measured = self._scale * velocity + noise
        variance = self._dvl.noise_m_s**2 + (self._dvl.scale_error * measured) ** 2
        return DvlSample(stamp, measured, np.diag(variance))
