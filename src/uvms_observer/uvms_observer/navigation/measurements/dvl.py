"""The Doppler velocity log: velocity of its transducer over ground, or through the water.

What it tells of the errors is that of its reading,

    du = A (dv + [v]x (dtheta + R dm) + v ds / (1 + s)):

how much of it is the velocity's, and how much that of attitude, misalignment m and scale s, it does
not tell. The estimated velocity v follows the sensor's noise, which would look like a motion that
tells them apart: the filter would become certain of what it does not know, and the estimates would
drift with the square of the noise. Hence H has the velocity after the last sample in the columns of
m and s, which cannot be correlated with the noise of this one, and after a correction the
velocity's error is taken anew such that du stays what it is. True accelerations tell nothing of m
and s in this way; beside those of noise they tell next to nothing. Position fixes do.

Consistency of extended Kalman filters: Huang, Mourikis and Roumeliotis (2010); errors that are
those of what is observed: Barrau and Bonnabel (2017).
"""

import numpy as np

from uvms_core.signals import WATER_LOCK, Array, DvlSample
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Dvl
from uvms_dynamics.kernels import products
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.arrays import body_rate, product, subtract_from, transposed
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.inertial.installation import rate_variance
from uvms_observer.navigation.measurements.base import Linear, Measurement
from uvms_observer.navigation.measurements.noise import as_white, bounded, most_alike
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import (
    CURRENT,
    DVL_MISALIGNMENT,
    DVL_SCALE,
    FURTHER,
    MOUNTING,
    SIZE,
    Fields,
    NavigationState,
)

WATER_NOISE_M_S = 0.03
"""Std of the water's own motion in the layer that a sample looks into, m/s: waves, turbulence."""


class DvlVelocity(Measurement):
    """(1 + s) (1 - [m]x) (R^T (v - c) + w x d) + n, with scale error s and misalignment m.

    The current c is 0 for a sample with bottom lock.
    """

    size = 3
    needs_rate = True
    follows = True

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
        self.most_alike = most_alike(section.noise_m_s, section.resolution_m_s, self.size)
        self._section, self._seabed = section, vehicle.environment.seabed_depth_m
        self._as_white = as_white(float(np.hypot(section.scale_error, mounting)), section.rate_hz)

    def out_of_reach(self, state: NavigationState) -> str:
        """As `Measurement.out_of_reach`."""
        in_water = self._section.lock == WATER_LOCK or self._seabed is None
        altitude = np.inf if in_water else self._seabed - self.place(state)[2]
        down = float(quat_to_matrix(state.quaternion)[2, 2])
        return "" if self._section.reaches(altitude, down) else "no bottom within its range"

    def correct(self, state: NavigationState, sample: DvlSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        variance, in_water = self._variance_of(sample), sample.lock == WATER_LOCK
        if not self._has_states:
            return self._correct_alone(state, sample, variance, rate, gate)
        turning = self.lever, rate, self._rate_variance
        return correct_velocity(tuple(state), sample.velocity, variance, *turning, in_water, gate)

    def _variance_of(self, sample: DvlSample) -> float:
        """White noise along each axis, m^2/s^2."""
        in_water = sample.lock == WATER_LOCK
        return self._variance + (WATER_NOISE_M_S**2 if in_water else 0.0) + self._excess(sample)

    def _excess(self, sample: DvlSample) -> float:
        """Variance that the message states beyond what the vehicle file knows of; the largest."""
        stated = sample.covariance.diagonal()
        if not stated.any():
            return 0.0
        known = self._noise**2 + (self._scale * sample.velocity) ** 2
        excess = float((stated - known).max())
        return bounded(excess)

    def _correct_alone(
        self, state: NavigationState, sample: DvlSample, variance: float, rate: Array, gate: float
    ) -> float:
        """As `correct_velocity`, of a further DVL: scale and misalignment in the state are not
        its own, and its own count as noise that lasts.
        """
        residual, H, N = self._about(state, sample, variance, rate)
        before = state.velocity.copy()
        distance: float = correct(state, H, residual, N, gate)
        if distance <= gate:
            keep_reading(state, before)
        return distance

    def reading(self, sample: DvlSample) -> Array:
        """As `Measurement.reading`."""
        return sample.velocity

    def about(self, state: NavigationState, sample: DvlSample, rate: Array) -> Linear:
        """As `Measurement.about`."""
        return self._about(state, sample, self._variance_of(sample), rate)

    def _about(
        self, state: NavigationState, sample: DvlSample, variance: float, rate: Array
    ) -> Linear:
        measured, own, mounting = sample.velocity, state.further.copy(), list(MOUNTING)
        if not self._has_states:
            own[np.array(mounting) - FURTHER] = 0.0
            variance += self._as_white * float(measured.dot(measured))
        right = state._replace(further=own)
        reading, H = velocity(right, self.lever, rate, sample.lock == WATER_LOCK)
        if not self._has_states:
            H[:, mounting] = 0.0
        arm = skew(self.lever)
        N = variance * np.eye(3) + self._rate_variance * (arm @ arm.T)
        N += (arm * state.excess[:3]) @ arm.T
        return Linear(measured - reading, H, N)


@exact_inner
def velocity(
    state: NavigationState, lever: Array, rate: Array, in_water: bool
) -> tuple[Array, Array]:
    """Velocity that the DVL should read (3,) m/s, its own axes, and H."""
    R = quat_to_matrix(state.quaternion)
    over, before = state.velocity.copy(), state.reference.copy()
    if in_water:
        for i in range(2):
            over[i] -= state.further[CURRENT - FURTHER + i]
            before[i] -= state.further[CURRENT - FURTHER + i]
    mount, turn = _mount(state), body_rate(state, rate)
    axes, arm = product(mount, transposed(R)), product(mount, skew(lever))
    turned = product(axes, skew(over))
    motion, known = _motion(R, over, lever, turn), _motion(R, before, lever, turn)
    reading, scaled = products.product(mount, motion), products.product(mount, known)
    cross = skew(known)
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
        H[i, DVL_SCALE] = scaled[i]
        reading[i] *= scale
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
def _motion(R: Array, over: Array, lever: Array, turn: Array) -> Array:
    """Velocity of the transducer (3,) m/s, body axes, at the rate `turn`, rad/s."""
    motion, swing = products.transposed_product(R, over), products.product(skew(lever), turn)
    for i in range(3):
        motion[i] -= swing[i]
    return motion


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
    N = product(arm, transposed(arm))
    for i in range(3):
        for k in range(3):
            N[i, k] = (variance if i == k else 0.0) + rate_variance * N[i, k]
            for m in range(3):
                N[i, k] += arm[i, m] * state.excess[m] * arm[k, m]
    before = state.velocity.copy()
    distance = correct(state, H, residual, N, gate)
    if distance <= gate:
        keep_reading(state, before)
    return distance


@exact_inner
def keep_reading(state: NavigationState, before: Array) -> None:
    """Take the velocity's error anew after its correction, so that it still says what was read.

    See the module. In place: dv <- dv - [c]x dtheta - [b]x R dm - b ds / (1 + s), where the
    velocity has changed by c since the filter came to the sample, and by b since the last one.

    Args:
        before: (3,) m/s, the velocity before the correction, map_ned.
    """
    P, R = state.covariance, quat_to_matrix(state.quaternion)
    turn = skew(state.velocity - before)
    b = state.velocity - state.reference
    mount, scale = product(skew(b), R), 1.0 + state.further[DVL_SCALE - FURTHER]
    T = np.empty((3, 7))  # by attitude, misalignment and scale
    for i in range(3):
        for k in range(3):
            T[i, k], T[i, 3 + k] = turn[i, k], mount[i, k]
        T[i, 6] = b[i] / scale
        state.reference[i] = state.velocity[i]
    changed = np.empty((3, SIZE))
    for i in range(3):
        for j in range(SIZE):
            changed[i, j] = _mixed(T, P[j], i)
    for i in range(3):
        for j in range(SIZE):
            P[3 + i, j] -= changed[i, j]
    for j in range(SIZE):
        for i in range(3):
            changed[i, j] = _mixed(T, P[j], i)
    for j in range(SIZE):
        for i in range(3):
            P[j, 3 + i] -= changed[i, j]
    for i in range(3):
        for j in range(i):  # rounded in another order
            P[3 + j, 3 + i] = P[3 + i, 3 + j]
    for j in range(state.cross.shape[0]):
        for i in range(3):
            state.cross[j, 3 + i] -= _mixed(T, state.cross[j], i)


@exact_inner
def _mixed(T: Array, errors: Array, i: int) -> float:
    """Row i of T times errors of attitude, misalignment and scale."""
    total = T[i, 6] * errors[DVL_SCALE]
    for k in range(3):
        total += T[i, k] * errors[6 + k] + T[i, 3 + k] * errors[DVL_MISALIGNMENT + k]
    return total
