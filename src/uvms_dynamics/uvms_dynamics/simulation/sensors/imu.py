"""Gyrocompass and inertial unit."""

import math

import numpy as np

from uvms_core.sensors import imu
from uvms_core.sensors.imu import LEVEL
from uvms_core.signals import Array, ImuSample, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Imu
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.rotations import (
    matrix_to_quat,
    quat_multiply,
    quat_to_rpy,
    rotation_vector_to_quat,
    rpy_to_quat,
)
from uvms_dynamics.simulation.sensors.imperfections import Errors, misalignment
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
        self._oriented = section.orientation
        self._noise = _errors(section, "noise")
        self._bias_std = _errors(section, "bias")
        self._bias = self._bias_std * self.rng.standard_normal(9)
        self._keep = math.exp(-to_seconds(period) / section.bias_time_constant_s)
        self._mount = misalignment(seed, self.type.name, section.misalignment_deg)
        self._errors = _further_errors(section, seed, self.type.name)
        variance = self._noise**2 + self._bias_std**2
        self._covariances = [np.diag(variance[k : k + 3]) for k in (0, 3, 6)]

    def sample(self, trajectory: Trajectory) -> tuple[ImuSample, ...]:
        """Samples that are due on the trajectory."""
        rows = trajectory.due(self.period)
        motion = trajectory.at_lever(rows, self._lever, self._gravity)
        errors = self._draw_errors(len(rows))
        return tuple(
            self._read(trajectory.stamps[row], trajectory.states[row], motion[k], errors[k])
            for k, row in enumerate(rows)
        )

    def _draw_errors(self, count: int) -> Array:
        """Biases and noise (k, 9) of so many samples; the biases go on."""
        draws = self.rng.standard_normal((count, 2, 9))
        walk = math.sqrt(1.0 - self._keep**2)
        return _add_biases(self._bias, self._keep, walk * self._bias_std, self._noise, draws)

    def _read(self, stamp: int, state: Array, motion: Array, error: Array) -> ImuSample:
        if self._errors.adds:
            error = error + self._errors.added(stamp)
        quaternion, turn, force = self._in_its_axes(state[QUATERNION:VELOCITY], motion)
        turned = _turned(quaternion, error[:3])
        turn, force = turn + error[3:6], force + error[6:]
        if self._errors.rounds:
            turned, turn, force = self._rounded(turned, turn, force)
        if not self._oriented:
            turned = LEVEL.copy()
        attitude, rate, specific = self._covariances
        return ImuSample(
            stamp, turned, turn, force, attitude, rate, specific, oriented=self._oriented
        )

    def _in_its_axes(self, quaternion: Array, motion: Array) -> tuple[Array, Array, Array]:
        """Attitude, turn rate and specific force about the unit's own axes, scaled as it does."""
        turn, force = motion[TURN], motion[FORCE]
        if self._mount is not None:
            quaternion = quat_multiply(quaternion, matrix_to_quat(self._mount))
            turn, force = self._mount.T @ turn, self._mount.T @ force
        if not self._errors.scales:
            return quaternion, turn, force
        scaled = self._errors.scaled(np.concatenate([np.zeros(3), turn, force]))
        return quaternion, scaled[3:6], scaled[6:]

    def _rounded(self, turned: Array, turn: Array, force: Array) -> tuple[Array, Array, Array]:
        """Roll, pitch and heading, rates and forces in steps of their resolution."""
        values = np.concatenate([quat_to_rpy(turned), turn, force])
        rounded = self._errors.rounded(values)
        if (rounded[:3] != values[:3]).any():
            turned = rpy_to_quat(*rounded[:3])
        return turned, rounded[3:6], rounded[6:]


def _further_errors(section: Imu, seed: int, name: str) -> Errors:
    """Random walks, scales, steps and outliers of attitude, turn rate and specific force, SI."""

    def of_all(attitude_deg: float, gyro_deg_s: float, accelerometer_m_s2: float) -> Array:
        angles = np.radians([attitude_deg, gyro_deg_s])
        return np.repeat([*angles, accelerometer_m_s2], 3)

    return Errors(
        seed,
        name,
        9,
        walk=of_all(
            section.attitude_random_walk_deg,
            section.gyro_random_walk_deg_s,
            section.accelerometer_random_walk_m_s2,
        ),
        scale=np.repeat([0.0, section.gyro_scale_error, section.accelerometer_scale_error], 3),
        resolution=of_all(
            section.attitude_resolution_deg,
            section.gyro_resolution_deg_s,
            section.accelerometer_resolution_m_s2,
        ),
        outlier=of_all(
            section.attitude_outlier_deg,
            section.gyro_outlier_deg_s,
            section.accelerometer_outlier_m_s2,
        ),
        outlier_rate=section.outlier_rate,
    )


@exact_kernel
def _add_biases(bias: Array, keep: float, walk: Array, noise: Array, draws: Array) -> Array:
    """Errors (k, 9) of draws (k, 2, 9); the bias (9,) becomes that of the last one."""
    errors = np.empty((draws.shape[0], 9))
    for k in range(draws.shape[0]):
        for i in range(9):
            bias[i] = keep * bias[i] + walk[i] * draws[k, 0, i]
            errors[k, i] = bias[i] + noise[i] * draws[k, 1, i]
    return errors


@exact_kernel
def _turned(quaternion: Array, error: Array) -> Array:
    """An attitude with an error about the body axes, a rotation vector (3,)."""
    return quat_multiply(quaternion, rotation_vector_to_quat(error))


def _errors(section: Imu, kind: str) -> Array:
    """Standard deviations (9,) of attitude, turn rate and specific force, SI."""
    tilt = getattr(section, f"roll_pitch_{kind}_deg")
    attitude = np.radians([tilt, tilt, getattr(section, f"heading_{kind}_deg")])
    gyro = math.radians(getattr(section, f"gyro_{kind}_deg_s"))
    return np.concatenate(
        [attitude, np.full(3, gyro), np.full(3, getattr(section, f"accelerometer_{kind}_m_s2"))]
    )
