"""Gyrocompass and inertial unit."""

import math

import numpy as np

from uvms_core.sensors import imu
from uvms_core.signals import Array, ImuSample, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Imu
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat
from uvms_dynamics.simulation.sensors.model import SensorModel
from uvms_dynamics.simulation.sensors.mounting import (
    FORCE,
    QUATERNION,
    TURN,
    VELOCITY,
    Trajectory,
)


class ImuSensor(SensorModel):
    """Attitude, turn rate and specific force with white noise and Gauss-Markov biases.

    The attitude's error is a small turn about the body axes; the accelerometers sit at the lever
    arm. Biases: b' = exp(-dt/T) b + sqrt(1 - exp(-2 dt/T)) sigma w, drawn from their stationary
    distribution at the start.
    """

    type = imu.TYPE

    def __init__(self, vehicle: Vehicle, section: Imu, period: int, seed: int) -> None:
        super().__init__(vehicle, section, period, seed)
        self._gravity = vehicle.environment.gravity_m_s2
        self._lever = np.array(section.position_m)
        self._noise = _errors(section, "noise")
        self._bias_std = _errors(section, "bias")
        self._bias = self._bias_std * self.rng.standard_normal(9)
        self._keep = math.exp(-to_seconds(period) / section.bias_time_constant_s)
        variance = self._noise**2 + self._bias_std**2
        self._covariances = tuple(np.diag(variance[k : k + 3]) for k in (0, 3, 6))

    def sample(self, trajectory: Trajectory) -> tuple[ImuSample, ...]:
        """Samples that are due on the trajectory."""
        rows = trajectory.due(self.period)
        motion = trajectory.at_lever(rows, self._lever, self._gravity)
        draws = self.rng.standard_normal((len(rows), 2, 9))
        return tuple(
            self._read(trajectory.stamps[row], trajectory.states[row], motion[k], draws[k])
            for k, row in enumerate(rows)
        )

    def _read(self, stamp: int, state: Array, motion: Array, draws: Array) -> ImuSample:
        walk = math.sqrt(1.0 - self._keep**2)
        self._bias = self._keep * self._bias + walk * self._bias_std * draws[0]
        error = self._bias + self._noise * draws[1]
        turned = quat_multiply(state[QUATERNION:VELOCITY], rotation_vector_to_quat(error[:3]))
        return ImuSample(
            stamp, turned, motion[TURN] + error[3:6], motion[FORCE] + error[6:], *self._covariances
        )


def _errors(section: Imu, kind: str) -> Array:
    """Standard deviations (9,) of attitude, turn rate and specific force, SI."""
    tilt = getattr(section, f"roll_pitch_{kind}_deg")
    attitude = np.radians([tilt, tilt, getattr(section, f"heading_{kind}_deg")])
    gyro = math.radians(getattr(section, f"gyro_{kind}_deg_s"))
    return np.concatenate(
        [attitude, np.full(3, gyro), np.full(3, getattr(section, f"accelerometer_{kind}_m_s2"))]
    )
