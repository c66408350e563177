"""The filter's equations with full matrices in plain numpy, to compare its kernels with.

Slow and plain: every function returns new values and reads like the formulas in docs/navigation.md.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import (
    quat_multiply,
    quat_to_matrix,
    rotation_vector_to_quat,
    skew,
)
from uvms_observer.navigation.propagation import BEYOND, ProcessNoise
from uvms_observer.navigation.state import (
    ACCELEROMETER_BIAS,
    ATTITUDE,
    COMPASS_BIAS,
    DVL_MISALIGNMENT,
    DVL_SCALE,
    FURTHER,
    GYRO_BIAS,
    POSITION,
    SIZE,
    VELOCITY,
    NavigationState,
)

LATER = slice(9, SIZE)


def plus(state: NavigationState, e: Array) -> NavigationState:
    """State (+) error e (SIZE,): R <- Exp(dtheta) R, all else added."""
    turned = quat_multiply(rotation_vector_to_quat(e[ATTITUDE]), state.quaternion)
    return NavigationState(
        state.position + e[POSITION],
        state.velocity + e[VELOCITY],
        turned / np.linalg.norm(turned),
        state.gyro_bias + e[GYRO_BIAS],
        state.accelerometer_bias + e[ACCELEROMETER_BIAS],
        state.compass_bias + e[COMPASS_BIAS],
        state.further + e[FURTHER:],
        state.covariance,
        state.innovation,
        state.reference,
    )


def decayed(bias: Array, variance: Array, phi: Array) -> Array:
    """Gauss-Markov, but for a bias that is far beyond its deviation: that one has stepped."""
    return np.where(np.square(bias) < BEYOND**2 * variance, phi * bias, bias)


def propagated_mean(
    state: NavigationState,
    rate: Array,
    force: Array,
    dt: float,
    gravity: float,
    phi: Array,
    variance: Array | None = None,
) -> NavigationState:
    """Nominal state after dt under mean rate and mean specific force, covariance unchanged."""
    half = rotation_vector_to_quat(0.5 * dt * (rate - state.gyro_bias))
    middle = quat_multiply(state.quaternion, half)
    force_world = quat_to_matrix(middle) @ (force - state.accelerometer_bias)
    acceleration = force_world + np.array([0.0, 0.0, gravity])
    variance = np.full(SIZE - 9, np.inf) if variance is None else variance
    return NavigationState(
        state.position + state.velocity * dt + 0.5 * acceleration * dt**2,
        state.velocity + acceleration * dt,
        quat_multiply(middle, half),
        decayed(state.gyro_bias, variance[:3], phi[:3]),
        decayed(state.accelerometer_bias, variance[3:6], phi[3:6]),
        phi[6:9] * state.compass_bias,
        phi[9:] * state.further,
        state.covariance,
        state.innovation,
        state.reference,
    )


def transition_matrix(
    state: NavigationState, rate: Array, force: Array, dt: float, phi: Array
) -> Array:
    """F (SIZE, SIZE): e after dt = F e before."""
    half = rotation_vector_to_quat(0.5 * dt * (rate - state.gyro_bias))
    R = quat_to_matrix(quat_multiply(state.quaternion, half))
    A = skew(R @ (force - state.accelerometer_bias))
    F = np.eye(SIZE)
    F[POSITION, VELOCITY] = np.eye(3) * dt
    F[ATTITUDE, GYRO_BIAS] = -R * dt
    F[VELOCITY, ATTITUDE] = -A * dt
    F[VELOCITY, GYRO_BIAS] = 0.5 * A @ R * dt**2
    F[VELOCITY, ACCELEROMETER_BIAS] = -R * dt
    F[POSITION, ATTITUDE] = 0.5 * dt * F[VELOCITY, ATTITUDE]
    F[POSITION, GYRO_BIAS] = 0.5 * dt * F[VELOCITY, GYRO_BIAS]
    F[POSITION, ACCELEROMETER_BIAS] = 0.5 * dt * F[VELOCITY, ACCELEROMETER_BIAS]
    F[LATER, LATER] = np.diag(phi)
    return F


def process_covariance(noise: ProcessNoise, dt: float, phi: Array) -> Array:
    """Q (SIZE, SIZE) that dt adds."""
    Q = np.zeros((SIZE, SIZE))
    Q[POSITION, POSITION] = np.eye(3) * noise.accelerometer * dt**3 / 3.0
    Q[POSITION, VELOCITY] = Q[VELOCITY, POSITION] = np.eye(3) * noise.accelerometer * dt**2 / 2.0
    Q[VELOCITY, VELOCITY] = np.eye(3) * noise.accelerometer * dt
    Q[ATTITUDE, ATTITUDE] = np.eye(3) * noise.gyro * dt
    Q[LATER, LATER] = np.diag((1.0 - phi**2) * noise.variance)
    return Q


def propagated(
    state: NavigationState,
    rate: Array,
    force: Array,
    dt: float,
    gravity: float,
    noise: ProcessNoise,
) -> NavigationState:
    """Nominal state and covariance F P F^T + Q after dt."""
    phi = np.exp(-dt * noise.decay)
    F = transition_matrix(state, rate, force, dt, phi)
    covariance = F @ state.covariance @ F.T + process_covariance(noise, dt, phi)
    mean = propagated_mean(state, rate, force, dt, gravity, phi, noise.variance)
    return mean._replace(covariance=covariance)


def corrected(
    state: NavigationState, H: Array, residual: Array, N: Array, is_fix: bool
) -> NavigationState:
    """State and covariance after one measurement, Joseph form; only fixes tell of the mounting."""
    P = state.covariance
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + N)
    if not is_fix:
        K[DVL_SCALE], K[DVL_MISALIGNMENT : DVL_MISALIGNMENT + 3] = 0.0, 0.0
    left = np.eye(SIZE) - K @ H
    covariance = left @ P @ left.T + K @ N @ K.T
    return plus(state, K @ residual)._replace(covariance=covariance)
