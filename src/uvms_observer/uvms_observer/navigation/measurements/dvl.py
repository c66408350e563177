"""The Doppler velocity log: velocity of its transducer over ground."""

import numpy as np

from uvms_core.signals import BOTTOM_LOCK, Array, DvlSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.arrays import body_rate, subtract_from, transposed
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.installation import rate_variance
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.noise import as_white
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import DVL_SCALE, SIZE, Fields, NavigationState


class DvlVelocity(Measurement):
    """(1 + s) (R^T v + w x d) + n, with the scale error s in the state."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: Dvl, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self._variance = max(section.noise_m_s, config.noise_floor.velocity_m_s) ** 2
        self._rate_variance = rate_variance(vehicle)
        self._noise, self._scale = section.noise_m_s, section.scale_error
        self._has_scale_state = section is vehicle.sensors.dvl
        self._as_white = as_white(section.scale_error, section.rate_hz)
        if self._has_scale_state:
            self.initial_variance = {DVL_SCALE: float(np.square(section.scale_error))}

    def usable(self, sample: DvlSample) -> bool:
        """Whether it is over ground: the water's own motion is not known."""
        return sample.lock == BOTTOM_LOCK

    def correct(self, state: NavigationState, sample: DvlSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        noise, fields = self._rate_variance, tuple(state)
        variance = self._variance + self._excess(sample)
        if not self._has_scale_state:
            variance += self._as_white * float(sample.velocity.dot(sample.velocity))
            return self._correct_alone(state, sample.velocity, variance, rate, gate)
        return correct_velocity(fields, sample.velocity, variance, self.lever, rate, noise, gate)

    def _excess(self, sample: DvlSample) -> float:
        """Variance that the message states beyond what the vehicle file knows of; the largest."""
        stated = sample.covariance.diagonal()
        if not stated.any():
            return 0.0
        known = self._noise**2 + (self._scale * sample.velocity) ** 2
        return max(float((stated - known).max()), 0.0)

    def _correct_alone(
        self, state: NavigationState, measured: Array, variance: float, rate: Array, gate: float
    ) -> float:
        """As `correct_velocity`, of a further DVL: the scale error of the state is another's."""
        expected, H = velocity(state, self.lever, rate)
        scale = 1.0 + state.instrument_bias[0]
        H /= scale
        H[:, DVL_SCALE] = 0.0
        arm = skew(self.lever)
        N = variance * np.eye(3) + self._rate_variance * (arm @ arm.T)
        return correct(state, H, measured - expected / scale, N, gate)


@exact_inner
def velocity(state: NavigationState, lever: Array, rate: Array) -> tuple[Array, Array]:
    """Velocity that the DVL should read (3,) m/s, body axes, and H."""
    R = quat_to_matrix(state.quaternion)
    arm, turned = skew(lever), R.T @ skew(state.velocity)
    reading, swing = R.T @ state.velocity, arm @ body_rate(state, rate)
    scale = 1.0 + state.instrument_bias[0]
    H = np.zeros((3, SIZE))
    for i in range(3):
        motion = reading[i] - swing[i]
        for k in range(3):
            H[i, 3 + k] = scale * R[k, i]
            H[i, 6 + k] = scale * turned[i, k]
            H[i, 9 + k] = scale * arm[i, k]
        H[i, 18] = motion
        reading[i] = scale * motion
    return reading, H


@exact_kernel
def correct_velocity(
    fields: Fields,
    measured: Array,
    variance: float,
    lever: Array,
    rate: Array,
    rate_variance: float,
    gate: float,
) -> float:
    """DVL: velocity (3,) m/s in body axes; the gyro's noise enters by the lever arm."""
    state = NavigationState(*fields)
    residual, H = velocity(state, lever, rate)
    subtract_from(measured, residual)
    arm = skew(lever)
    N = arm @ transposed(arm)
    for i in range(3):
        for k in range(3):
            N[i, k] = (variance if i == k else 0.0) + rate_variance * N[i, k]
    return correct(state, H, residual, N, gate)
