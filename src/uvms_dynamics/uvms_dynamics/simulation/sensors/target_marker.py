"""A camera that sees a marker on the work object."""

import numpy as np

from uvms_core.sensors import target_marker
from uvms_core.sensors.target_marker import MarkerSample, TargetMarker
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.rotations import (
    matrix_to_quat,
    quat_multiply,
    quat_to_matrix,
    rotation_vector_to_quat,
)
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, VELOCITY, Trajectory


class TargetMarkerSensor(SensorModel):
    """Pose of the marker in the camera's frame, with white noise, wherever it is in view.

    Where navigation knows the marker's place with some uncertainty, the true one is drawn from it.
    """

    type = target_marker.TYPE

    def __init__(self, vehicle: Vehicle, section: TargetMarker, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._section = section
        self._lever, self._mount = np.array(section.position_m), section.sensor_axes
        place, turn = self.rng.standard_normal((2, 3))
        turn = np.radians(section.target_std_deg) * turn
        self.place: Array = np.array(section.target_position_m)
        """True place of the marker, (3,) m, map_ned."""
        if section.target_std_m is not None:
            self.place = self.place + section.target_std_m * place
        self.R_map_marker: Array = quat_to_matrix(
            quat_multiply(rotation_vector_to_quat(turn), section.target_quaternion)
        )
        """Its true attitude."""

    def sample(self, trajectory: Trajectory) -> tuple[MarkerSample, ...]:
        """Sights that are due on the trajectory, where there are any."""
        sights = (self._sight(trajectory, row) for row in trajectory.due(self.period))
        return tuple(sight for sight in sights if sight is not None)

    def _sight(self, trajectory: Trajectory, row: int) -> MarkerSample | None:
        noise = self.rng.standard_normal((2, 3))  # drawn in any case: seeds stay in step
        state, section = trajectory.states[row], self._section
        R = quat_to_matrix(state[QUATERNION:VELOCITY])
        R_map_camera = R @ self._mount
        seen = R_map_camera.T @ (self.place - state[:3] - R @ self._lever)
        R_camera_marker = R_map_camera.T @ self.R_map_marker
        if not section.recognises(seen, R_camera_marker[:, 2]):
            return None
        std = section.noise_m + section.noise_m_per_m * float(np.linalg.norm(seen))
        turn = np.radians(section.angle_noise_deg)
        attitude = quat_multiply(
            rotation_vector_to_quat(turn * noise[1]), matrix_to_quat(R_camera_marker)
        )
        spread = np.diag(np.repeat([std**2, turn**2], 3))
        return MarkerSample(trajectory.stamps[row], seen + std * noise[0], attitude, spread)
