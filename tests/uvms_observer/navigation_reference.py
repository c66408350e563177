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
        state.excess,
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
        state.excess,
    )


def middle_attitude(state: NavigationState, rate: Array, dt: float) -> Array:
    """R (3, 3) in the middle of the interval."""
    half = rotation_vector_to_quat(0.5 * dt * (rate - state.gyro_bias))
    middle: Array = quat_to_matrix(quat_multiply(state.quaternion, half))
    return middle


def transition_matrix(
    state: NavigationState, rate: Array, force: Array, dt: float, phi: Array
) -> Array:
    """F (SIZE, SIZE): e after dt = F e before."""
    R = middle_attitude(state, rate, dt)
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


def process_covariance(
    noise: ProcessNoise, dt: float, phi: Array, R: Array, excess: Array
) -> Array:
    """Q (SIZE, SIZE) that dt adds, at the attitude R in its middle."""
    gyro = np.eye(3) * noise.gyro + R @ np.diag(excess[:3] * noise.period) @ R.T
    force = np.eye(3) * noise.accelerometer + R @ np.diag(excess[3:] * noise.period) @ R.T
    Q = np.zeros((SIZE, SIZE))
    Q[POSITION, POSITION] = force * dt**3 / 3.0
    Q[POSITION, VELOCITY] = Q[VELOCITY, POSITION] = force * dt**2 / 2.0
    Q[VELOCITY, VELOCITY] = force * dt
    Q[ATTITUDE, ATTITUDE] = gyro * dt
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
    R = middle_attitude(state, rate, dt)
    Q = process_covariance(noise, dt, phi, R, state.excess)
    covariance = F @ state.covariance @ F.T + Q
    mean = propagated_mean(state, rate, force, dt, gravity, phi, noise.variance)
    return mean._replace(covariance=covariance)


def conditional(P: Array) -> Array:
    """Covariance (SIZE, SIZE) of the other states where the DVL's mounting and scale are known."""
    k = [DVL_SCALE, *range(DVL_MISALIGNMENT, DVL_MISALIGNMENT + 3)]
    known = P - P[:, k] @ np.linalg.inv(P[np.ix_(k, k)]) @ P[k]
    known[k], known[:, k] = 0.0, 0.0
    return known


def corrected(
    state: NavigationState, H: Array, residual: Array, N: Array, is_fix: bool
) -> NavigationState:
    """State and covariance after one measurement, Joseph form; only fixes tell of the mounting."""
    P = state.covariance
    known = P if is_fix else conditional(P)
    K = known @ H.T @ np.linalg.inv(H @ known @ H.T + N)
    left = np.eye(SIZE) - K @ H
    covariance = left @ P @ left.T + K @ N @ K.T
    return plus(state, K @ residual)._replace(covariance=covariance)
