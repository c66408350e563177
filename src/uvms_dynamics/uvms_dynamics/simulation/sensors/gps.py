"""Satellite receiver."""

import math

import numpy as np

from uvms_core.geodesy import ned_to_geodetic
from uvms_core.sensors import gps
from uvms_core.signals import Array, GpsSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Gps
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.error_model import Errors
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class GpsSensor(SensorModel):
    """Latitude, longitude and altitude of the antenna; no fix under water."""

    type = gps.TYPE

    def __init__(self, vehicle: Vehicle, section: Gps, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        sea = vehicle.environment
        self._lever = np.array(section.position_m)
        self._datum = (sea.datum_latitude_deg, sea.datum_longitude_deg)
        self._noise = _by_axis(section.horizontal_noise_m, section.vertical_noise_m)
        self._errors = Errors(
            seed,
            self.type.name,
            3,
            bias=_by_axis(section.horizontal_bias_m, section.vertical_bias_m),
            walk=_by_axis(section.horizontal_random_walk_m, section.vertical_random_walk_m),
            resolution=section.resolution_m,
            outlier=section.outlier_m,
            outlier_rate=section.outlier_rate,
        )
        self._covariance = np.diag(self._noise**2)

    def sample(self, trajectory: Trajectory) -> tuple[GpsSample, ...]:
        """Samples that are due on the trajectory."""
        return tuple(self._read(trajectory, row) for row in trajectory.due(self.period))

    def _read(self, trajectory: Trajectory, row: int) -> GpsSample:
        stamp, state = trajectory.stamps[row], trajectory.states[row]
        place = state[:3] + quat_to_matrix(state[QUATERNION:VELOCITY]) @ self._lever
        if place[2] >= 0.0:
            return GpsSample(stamp, False, math.nan, math.nan, math.nan, self._covariance)
        noisy = place + self._noise * self.rng.standard_normal(3)
        measured = self._errors.completed(stamp, noisy)
        return GpsSample(stamp, True, *ned_to_geodetic(measured, *self._datum), self._covariance)


def _by_axis(horizontal: float, vertical: float) -> Array:
    """(3,) north, east, down."""
    return np.array([horizontal, horizontal, vertical])
