"""Doppler velocity log."""

import math
from dataclasses import replace

import numpy as np

from uvms_core.sensors import dvl
from uvms_core.signals import BOTTOM_LOCK, WATER_LOCK, Array, DvlSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.simulation.sensors.imperfections import Errors, misalignment
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import QUATERNION, SPEED, VELOCITY, Trajectory


class DvlSensor(SensorModel):
    """Velocity over ground at the lever arm, its own axes: (1 + s) R^T (v + omega x r) + errors.

    Or through the water, where the vehicle file says that it is locked to that.

    Without bottom lock there is no sample: too near to the seabed or too far from it, or tilted.
    """

    type = dvl.TYPE

    def __init__(self, vehicle: Vehicle, section: Dvl, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._dvl = section
        self._lever = np.array(section.position_m)
        self._scale = 1.0 + section.scale_error * self.rng.standard_normal()
        self._mount = misalignment(seed, self.type.name, section.misalignment_deg)
        self._seabed = vehicle.environment.seabed_depth_m
        if section.lock == WATER_LOCK:
            self._seabed = None  # it needs none
        self._can_lose = self._seabed is not None or section.max_tilt_deg is not None
        self._errors = Errors(
            seed,
            self.type.name,
            3,
            bias=section.bias_m_s,
            walk=section.random_walk_m_s,
            resolution=section.resolution_m_s,
            outlier=section.outlier_m_s,
            outlier_rate=section.outlier_rate,
        )

    def sample(self, trajectory: Trajectory) -> tuple[DvlSample, ...]:
        """Samples that are due on the trajectory."""
        rows = trajectory.due(self.period)
        if self._can_lose:
            rows = [row for row in rows if self._has_bottom_lock(trajectory.states[row])]
        if not rows:
            return ()
        motion = self._moving_against(trajectory).at_lever(rows, self._lever, 0.0)
        return tuple(
            self._read(trajectory.stamps[row], motion[k, SPEED]) for k, row in enumerate(rows)
        )

    def _read(self, stamp: int, velocity: Array) -> DvlSample:
        noise = self._dvl.noise_m_s * self.rng.standard_normal(3)
        if self._mount is not None:
            velocity = self._mount.T @ velocity
        measured = self._errors.completed(stamp, self._scale * velocity + noise)
        variance = self._dvl.noise_m_s**2 + (self._dvl.scale_error * measured) ** 2
        return DvlSample(stamp, measured, np.diag(variance), self._dvl.lock)

    def _moving_against(self, trajectory: Trajectory) -> Trajectory:
        """The motion over ground, or through the water, whose own motion is left out then."""
        if self._dvl.lock == BOTTOM_LOCK:
            return trajectory
        return replace(trajectory, current=np.zeros(3), water=None)

    def _has_bottom_lock(self, state: Array) -> bool:
        down = quat_to_matrix(state[QUATERNION:VELOCITY])[2]
        seabed = math.inf if self._seabed is None else self._seabed
        return self._dvl.reaches(seabed - (state[2] + float(down @ self._lever)), down[2])
