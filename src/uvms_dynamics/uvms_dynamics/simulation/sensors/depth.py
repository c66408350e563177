"""A depth gauge that gives metres."""

import numpy as np

from uvms_core.sensors import depth
from uvms_core.sensors.depth import Depth, DepthSample
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class DepthSensor(SensorModel):
    """Depth of the sensor, of waves too, with a constant bias and white noise; 0 in the air."""

    type = depth.TYPE

    def __init__(self, vehicle: Vehicle, section: Depth, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._lever = np.array(section.position_m)
        self._noise = section.noise_m
        self._bias = section.bias_m * self.rng.standard_normal()
        self._variance = section.noise_m**2 + section.bias_m**2

    def sample(self, trajectory: Trajectory) -> tuple[DepthSample, ...]:
        """Samples that are due on the trajectory."""
        return tuple(self._read(trajectory, row) for row in trajectory.due(self.period))

    def _read(self, trajectory: Trajectory, row: int) -> DepthSample:
        state = trajectory.states[row]
        place = state[:3] + quat_to_matrix(state[QUATERNION:VELOCITY]) @ self._lever
        true = max(float(place[2]) + trajectory.wave_head(row, place), 0.0)
        error = self._bias + self._noise * self.rng.standard_normal()
        return DepthSample(trajectory.stamps[row], true + error, self._variance)
