"""What each sensor should read at the estimated state, and its derivative by the error state.

Sensors are mounted at the lever arm d from the IMU (body axes), which turns with w = w_m - b_g:

    gyrocompass  R_m = R Exp(b_c + n)
    DVL          (1 + s) (R^T v + w x d) + n
    pressure     (p + R d)_z + b_p + n          (as depth)
    GPS          p + R d + n

Each function returns the expected value and its derivative H (m, 20); tests check H against finite
differences.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner
from uvms_dynamics.kernels.rotations import (
    quat_conjugate,
    quat_multiply,
    quat_to_matrix,
    quat_to_rotation_vector,
    rotation_vector_to_quat,
    skew,
)
from uvms_observer.navigation.state import SIZE, NavigationState


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


@exact_inner
def body_rate(state: NavigationState, rate: Array) -> Array:
    """The gyro's rate (3,) without its estimated bias."""
    omega = np.empty(3)
    for i in range(3):
        omega[i] = rate[i] - state.gyro_bias[i]
    return omega


@exact_inner
def depth(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Depth that the pressure should show (1,) m, and H."""
    offset = quat_to_matrix(state.quaternion) @ lever
    H = np.zeros((1, SIZE))
    H[0, 2] = 1.0
    H[0, 6] = offset[1]
    H[0, 7] = -offset[0]
    H[0, 19] = 1.0
    reading = np.empty(1)
    reading[0] = state.position[2] + offset[2] + state.instrument_bias[1]
    return reading, H


@exact_inner
def position(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Position of the antenna (3,) m, map_ned, and H."""
    offset = quat_to_matrix(state.quaternion) @ lever
    H, arm = np.zeros((3, SIZE)), skew(offset)
    for i in range(3):
        H[i, i] = 1.0
        for k in range(3):
            H[i, 6 + k] = -arm[i, k]
        offset[i] += state.position[i]
    return offset, H
