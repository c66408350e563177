"""A compass, or another sensor of the heading."""

import numpy as np

from uvms_core.sensors import heading
from uvms_core.sensors.heading import Heading, HeadingSample
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class HeadingSensor(SensorModel):
    """The attitude, turned about the vertical by bias and noise."""

    type = heading.TYPE

    def __init__(self, vehicle: Vehicle, section: Heading, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._noise = float(np.radians(section.noise_deg))
        bias = float(np.radians(section.bias_deg))
        self._bias = bias * self.rng.standard_normal()
        self._covariance = np.diag([0.0, 0.0, self._noise**2 + bias**2])

    def sample(self, trajectory: Trajectory) -> tuple[HeadingSample, ...]:
        """Samples that are due on the trajectory."""
        return tuple(
            HeadingSample(
                trajectory.stamps[row],
                self._turned(trajectory.states[row, QUATERNION:VELOCITY]),
                self._covariance,
            )
            for row in trajectory.due(self.period)
        )

    def _turned(self, quaternion: Array) -> Array:
        error = self._bias + self._noise * self.rng.standard_normal()
        return quat_multiply(rotation_vector_to_quat(np.array([0.0, 0.0, error])), quaternion)
