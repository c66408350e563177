"""A magnetometer."""

import numpy as np

from uvms_core.sensors import magnetometer
from uvms_core.sensors.magnetometer import MICROTESLA, MagneticSample, Magnetometer
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class MagnetometerSensor(SensorModel):
    """The Earth's field at the site and a constant one of the vehicle's own, with white noise."""

    type = magnetometer.TYPE

    def __init__(self, vehicle: Vehicle, section: Magnetometer, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._earth = MICROTESLA * np.array(vehicle.environment.magnetic_field_ut)
        self._noise, bias = MICROTESLA * section.noise_ut, MICROTESLA * section.bias_ut
        self._bias = bias * self.rng.standard_normal(3)
        self._covariance = np.eye(3) * (self._noise**2 + bias**2)

    def sample(self, trajectory: Trajectory) -> tuple[MagneticSample, ...]:
        """Samples that are due on the trajectory."""
        return tuple(self._read(trajectory, row) for row in trajectory.due(self.period))

    def _read(self, trajectory: Trajectory, row: int) -> MagneticSample:
        R = quat_to_matrix(trajectory.states[row, QUATERNION:VELOCITY])
        field = R.T @ self._earth + self._bias + self._noise * self.rng.standard_normal(3)
        return MagneticSample(trajectory.stamps[row], field, self._covariance)
