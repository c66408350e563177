"""Position fixes under water: an acoustic positioning system, or a marker seen by a camera."""

import numpy as np

from uvms_core.sensors import position_fix
from uvms_core.sensors.position_fix import FixSample, PositionFix
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class PositionFixSensor(SensorModel):
    """Position of the sensor in the map, with white noise; only within range of its source."""

    type = position_fix.TYPE

    def __init__(self, vehicle: Vehicle, section: PositionFix, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._lever = np.array(section.position_m)
        vertical = section.vertical_noise_m or section.noise_m
        self._noise = np.array([section.noise_m, section.noise_m, vertical])
        self._source = None if section.source_m is None else np.array(section.source_m)
        self._range = np.inf if section.max_range_m is None else section.max_range_m

    def sample(self, trajectory: Trajectory) -> tuple[FixSample, ...]:
        """Fixes that are due on the trajectory, where there are any."""
        fixes = (self._fix(trajectory, row) for row in trajectory.due(self.period))
        return tuple(fix for fix in fixes if fix is not None)

    def _fix(self, trajectory: Trajectory, row: int) -> FixSample | None:
        state = trajectory.states[row]
        place = state[:3] + quat_to_matrix(state[QUATERNION:VELOCITY]) @ self._lever
        noise = self._noise * self.rng.standard_normal(3)  # drawn in any case: seeds stay in step
        if self._source is not None and np.linalg.norm(place - self._source) > self._range:
            return None
        return FixSample(trajectory.stamps[row], place + noise, np.diag(self._noise**2))
