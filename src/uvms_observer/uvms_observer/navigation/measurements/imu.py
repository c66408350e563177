"""The gyrocompass: its attitude; the inertial readings carry the state (`propagation.py`).

Without a gyrocompass gravity tells roll and pitch: the specific force is R^T (a - g), where the
vehicle's own acceleration a is small, and averages out over some seconds.
"""

from typing import Any

import numpy as np

from uvms_core.signals import Array, ImuSample, to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels import products
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    rotation_vector_to_quat,
    skew,
)
from uvms_observer.navigation.arrays import product, transposed
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.inertial.installation import attitude_variance, known_variance
from uvms_observer.navigation.inertial.unknown_motion import ACCELERATION_M_S2
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.measurements.noise import with_stated
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import SIZE, Fields, NavigationState

EVERY = to_nanoseconds(0.1)
"""Between two uses of gravity, ns."""
LASTS_S = 2.0
"""How long an acceleration of the vehicle lasts, s: so long its samples say the same."""


class Gyrocompass(Measurement):
    """R_m = R Exp(b_c + n), with the compass bias b_c in the state; else f = -R^T g + b_a + n."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: Any, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self.variance = attitude_variance(vehicle, config)
        self._known = known_variance(section)[0]
        self._gravity = vehicle.environment.gravity_m_s2
        self._period = to_nanoseconds(1.0 / section.rate_hz)
        self._force_variance = (
            ACCELERATION_M_S2**2 * LASTS_S / to_seconds(EVERY) + section.accelerometer_noise_m_s2**2
        )

    def usable(self, sample: ImuSample) -> bool:
        """Whether there is an attitude, or it is time for gravity."""
        return sample.oriented or sample.stamp % EVERY < self._period

    def _variance_of(self, sample: ImuSample) -> Array:
        """Of the noise of an attitude (3,) rad^2, about the body axes."""
        return with_stated(self.variance, sample.orientation_covariance, self._known)

    def correct(self, state: NavigationState, sample: ImuSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        if not sample.oriented:
            force, variance = sample.linear_acceleration, self._force_variance
            return correct_gravity(tuple(state), force, self._gravity, variance, gate)
        return correct_attitude(tuple(state), sample.quaternion, self._variance_of(sample), gate)


@exact_inner
def attitude(state: NavigationState, measured: Array) -> tuple[Array, Array]:
    """Rotation vector (3,) rad, map_ned, from the expected to the measured attitude, and H."""
    R = quat_to_matrix(state.quaternion)
    turn = rotation_vector_to_quat(products.product(R, state.compass_bias))
    expected = quat_multiply(turn, state.quaternion)
    H = np.zeros((3, SIZE))
    for i in range(3):
        H[i, 6 + i] = 1.0
        for k in range(3):
            H[i, 15 + k] = R[i, k]
    return quat_to_rotation_vector(quat_multiply(measured, quat_conjugate(expected))), H


@exact_kernel
def correct_attitude(fields: Fields, measured: Array, variance: Array, gate: float) -> float:
    """Gyrocompass: quaternion (4,), variances (3,) rad^2 about the body axes."""
    state = NavigationState(*fields)
    residual, H = attitude(state, measured)
    R = quat_to_matrix(state.quaternion)
    scaled = np.empty((3, 3))
    for i in range(3):
        for k in range(3):
            scaled[i, k] = R[i, k] * variance[k]
    return correct(state, H, residual, product(scaled, transposed(R)), gate)


@exact_inner
def specific_force(state: NavigationState, gravity: float) -> tuple[Array, Array]:
    """Specific force (3,) m/s^2 of a vehicle that does not accelerate, body axes, and H."""
    R = quat_to_matrix(state.quaternion)
    up = np.zeros(3)
    up[2] = -gravity
    turned, reading = product(transposed(R), skew(up)), products.transposed_product(R, up)
    H = np.zeros((3, SIZE))
    for i in range(3):
        H[i, 12 + i] = 1.0
        for k in range(3):
            H[i, 6 + k] = turned[i, k]
        reading[i] += state.accelerometer_bias[i]
    return reading, H


@exact_kernel
def correct_gravity(
    fields: Fields, measured: Array, gravity: float, variance: float, gate: float
) -> float:
    """Specific force (3,) m/s^2; its variance is that of the vehicle's acceleration as well."""
    state = NavigationState(*fields)
    residual, H = specific_force(state, gravity)
    N = np.zeros((3, 3))
    for i in range(3):
        residual[i] = measured[i] - residual[i]
        N[i, i] = variance + state.excess[3 + i]
    return correct(state, H, residual, N, gate)
