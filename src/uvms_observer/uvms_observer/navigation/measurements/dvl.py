"""The Doppler velocity log: velocity of its transducer over ground, or through the water."""

import numpy as np

from uvms_core.signals import WATER_LOCK, Array, DvlSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.arrays import body_rate, subtract_from, transposed
from uvms_observer.navigation.correction import correct, linearization_point
from uvms_observer.navigation.installation import rate_variance
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.noise import as_white
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import (
    CURRENT,
    DVL_MISALIGNMENT,
    DVL_SCALE,
    FURTHER,
    SIZE,
    Fields,
    NavigationState,
)

WATER_NOISE_M_S = 0.03
"""Std of the water's own motion in the layer that a sample looks into, m/s: waves, turbulence."""

LOOSE = 5.0
"""Velocity's std in those of the noise from which on a sample is linearized twice."""


class DvlVelocity(Measurement):
    """(1 + s) (1 - [m]x) (R^T (v - c) + w x d) + n, with scale error s and misalignment m.

    The current c is 0 for a sample with bottom lock.
    """

    size = 3
    needs_rate = True

    def __init__(self, vehicle: Vehicle, section: Dvl, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self._variance = max(section.noise_m_s, config.noise_floor.velocity_m_s) ** 2
        self._rate_variance = rate_variance(vehicle)
        mounting = np.radians(max(section.misalignment_deg, config.noise_floor.misalignment_deg))
        self._noise, self._scale = section.noise_m_s, section.scale_error
        self._has_states = section is vehicle.sensors.dvl
        if self._has_states:
            self.initial_variance = {
                DVL_SCALE: float(np.square(section.scale_error)),
                **dict.fromkeys(range(DVL_MISALIGNMENT, DVL_MISALIGNMENT + 3), float(mounting**2)),
            }
        self._as_white = as_white(float(np.hypot(section.scale_error, mounting)), section.rate_hz)

    def correct(self, state: NavigationState, sample: DvlSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        in_water = sample.lock == WATER_LOCK
        variance = self._variance + (WATER_NOISE_M_S**2 if in_water else 0.0)
        variance += self._excess(sample)
        if not self._has_states:
            return self._correct_alone(state, sample, variance, rate, gate)
        turning = self.lever, rate, self._rate_variance
        return correct_velocity(tuple(state), sample.velocity, variance, *turning, in_water, gate)

    def _excess(self, sample: DvlSample) -> float:
        """Variance that the message states beyond what the vehicle file knows of; the largest."""
        stated = sample.covariance.diagonal()
        if not stated.any():
            return 0.0
        known = self._noise**2 + (self._scale * sample.velocity) ** 2
        excess = float((stated - known).max())
        return excess if excess > 0.0 else 0.0

    def _correct_alone(
        self, state: NavigationState, sample: DvlSample, variance: float, rate: Array, gate: float
    ) -> float:
        """As `correct_velocity`, of a further DVL: scale and misalignment in the state are not
        its own, and its own count as noise that lasts.
        """
        measured, own = sample.velocity, state.further.copy()
        own[DVL_SCALE - FURTHER] = 0.0
        own[DVL_MISALIGNMENT - FURTHER : DVL_MISALIGNMENT - FURTHER + 3] = 0.0
        right = state._replace(further=own)
        expected, H = velocity(right, self.lever, rate, sample.lock == WATER_LOCK)
        H[:, DVL_SCALE] = 0.0
        H[:, DVL_MISALIGNMENT : DVL_MISALIGNMENT + 3] = 0.0
        arm = skew(self.lever)
        variance += self._as_white * float(measured.dot(measured))
        N = variance * np.eye(3) + self._rate_variance * (arm @ arm.T)
        return correct(state, H, measured - expected, N, gate)


@exact_inner
def velocity(
    state: NavigationState, lever: Array, rate: Array, in_water: bool
) -> tuple[Array, Array]:
    """Velocity that the DVL should read (3,) m/s, its own axes, and H."""
    R = quat_to_matrix(state.quaternion)
    over = state.velocity.copy()
    if in_water:
        for i in range(2):
            over[i] -= state.further[CURRENT - FURTHER + i]
    mount = _mount(state)
    axes, arm = mount @ transposed(R), mount @ skew(lever)
    reading, turned = axes @ over, axes @ skew(over)
    swing, motion = arm @ body_rate(state, rate), _motion(R, over, lever, state, rate)
    cross = skew(motion)
    scale = 1.0 + state.further[DVL_SCALE - FURTHER]
    H = np.zeros((3, SIZE))
    for i in range(3):
        for k in range(3):
            H[i, 3 + k] = scale * axes[i, k]
            H[i, 6 + k] = scale * turned[i, k]
            H[i, 9 + k] = scale * arm[i, k]
            H[i, DVL_MISALIGNMENT + k] = scale * cross[i, k]
        if in_water:
            for k in range(2):
                H[i, CURRENT + k] = -scale * axes[i, k]
        H[i, DVL_SCALE] = reading[i] - swing[i]
        reading[i] = scale * H[i, DVL_SCALE]
    return reading, H


@exact_inner
def _mount(state: NavigationState) -> Array:
    """Body axes to the DVL's own, (3, 3): 1 - [m]x for the small misalignment m."""
    m = np.empty(3)
    for i in range(3):
        m[i] = state.further[DVL_MISALIGNMENT - FURTHER + i]
    mount = skew(m)
    for i in range(3):
        for k in range(3):
            mount[i, k] = (1.0 if i == k else 0.0) - mount[i, k]
    return mount


@exact_inner
def _motion(R: Array, over: Array, lever: Array, state: NavigationState, rate: Array) -> Array:
    """Velocity of the transducer (3,) m/s, body axes."""
    motion, swing = transposed(R) @ over, skew(lever) @ body_rate(state, rate)
    for i in range(3):
        motion[i] -= swing[i]
    return motion


@exact_inner
def _is_loose(P: Array, variance: float) -> bool:
    """Whether a sample may change the velocity so much that it must be linearized after that.

    How misalignment and scale show in a sample is a matter of the velocity.
    """
    return P[3, 3] + P[4, 4] + P[5, 5] > 3.0 * LOOSE**2 * variance


@exact_kernel
def correct_velocity(
    fields: Fields,
    measured: Array,
    variance: float,
    lever: Array,
    rate: Array,
    rate_variance: float,
    in_water: bool,
    gate: float,
) -> float:
    """DVL: velocity (3,) m/s in its own axes; the gyro's noise enters by the lever arm."""
    state = NavigationState(*fields)
    residual, H = velocity(state, lever, rate, in_water)
    subtract_from(measured, residual)
    arm = skew(lever)
    N = arm @ transposed(arm)
    for i in range(3):
        for k in range(3):
            N[i, k] = (variance if i == k else 0.0) + rate_variance * N[i, k]
    if _is_loose(state.covariance, variance):
        point, e = linearization_point(state, H, residual, N)
        residual, H = velocity(point, lever, rate, in_water)
        subtract_from(measured, residual)
        moved = H @ e
        for i in range(3):
            residual[i] += moved[i]
    return correct(state, H, residual, N, gate)
