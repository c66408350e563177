"""The gyrocompass: its attitude; the inertial readings carry the state (`propagation.py`)."""

from typing import Any

import numpy as np

from uvms_core.signals import Array, ImuSample
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    rotation_vector_to_quat,
)
from uvms_observer.navigation.arrays import transposed
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.installation import attitude_variance
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.navigation_config import NavigationConfig
from uvms_observer.navigation.state import SIZE, Fields, NavigationState


class Gyrocompass(Measurement):
    """R_m = R Exp(b_c + n), with the compass bias b_c in the state."""

    size = 3

    def __init__(self, vehicle: Vehicle, section: Any, config: NavigationConfig) -> None:
        super().__init__(vehicle, section, config)
        self.variance = attitude_variance(vehicle, config)

    def correct(self, state: NavigationState, sample: ImuSample, rate: Array, gate: float) -> float:
        """As `Measurement.correct`."""
        return correct_attitude(tuple(state), sample.quaternion, self.variance, gate)


@exact_inner
def attitude(state: NavigationState, measured: Array) -> tuple[Array, Array]:
    """Rotation vector (3,) rad, map_ned, from the expected to the measured attitude, and H."""
    R = quat_to_matrix(state.quaternion)
    turn = rotation_vector_to_quat(R @ state.compass_bias)
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
    return correct(state, H, residual, scaled @ transposed(R), gate)
