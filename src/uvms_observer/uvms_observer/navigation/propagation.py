"""Strapdown propagation of the state and of its error covariance over one IMU interval.

Nominal state, with mean rate w = w_m - b_g and mean specific force f = f_m - b_a of the interval:

    R_mid = R Exp(w dt/2),  a = R_mid f + g e_z,
    p += v dt + a dt^2/2,   v += a dt,   R <- R Exp(w dt),   b <- phi b,

with phi = exp(-dt / T) for each bias and for the current.

Error state (derivation: docs/navigation.md), with A = [R_mid f]x:

    dtheta += -R_mid db_g dt
    dv     += -A dtheta dt - R_mid db_a dt + A R_mid db_g dt^2/2
    dp     +=  dv dt - A dtheta dt^2/2 - R_mid db_a dt^2/2 + A R_mid db_g dt^3/4

The rotation of the Earth is left out: the map is an inertial frame here, as it is in the plant. The
tests compare it with the same in full matrices.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_multiply, quat_to_matrix, rotation_vector_to_quat
from uvms_observer.navigation.state import FURTHER, SIZE, Fields, NavigationState

BEYOND = 5.0


class ProcessNoise(NamedTuple):
    """What makes the error grow between measurements."""

    gyro: float  # rad^2/s, spectral density of the rate's white noise
    accelerometer: float  # m^2/s^3, of the specific force's
    period: float  # s, of a sample: noise of variance s^2 has the spectral density s^2 period
    variance: Array  # (SIZE - 9,) stationary, of the states after the attitude, each of which is
    # first-order Gauss-Markov
    decay: Array  # (SIZE - 9,) 1/s, inverse of their time constants; 0 of one that is constant


@exact_kernel
def propagate(
    fields: Fields,
    rate_before: Array,
    rate: Array,
    force_before: Array,
    force: Array,
    dt: float,
    gravity: float,
    gyro: float,
    accelerometer: float,
    period: float,
    variance: Array,
    decay: Array,
) -> None:
    """Advance the state in place by dt, with the mean of the readings at both ends.

    The fields of a `ProcessNoise` come one by one: numba takes a named tuple apart as slowly as
    the rest is done.

    Args:
        fields: of the state.
        rate_before, rate: the gyro's readings, (3,) rad/s, body.
        force_before, force: the accelerometer's, (3,) m/s^2, body.
        dt: length of the interval, s.
        gravity: m/s^2, down.
        gyro, accelerometer, period, variance, decay: see `ProcessNoise`.
    """
    state = NavigationState(*fields)
    turn = np.empty(3)  # in the first half of the interval
    for i in range(3):
        turn[i] = (0.5 * (rate_before[i] + rate[i]) - state.gyro_bias[i]) * (0.5 * dt)
    half = rotation_vector_to_quat(turn)
    middle = quat_multiply(state.quaternion, half)
    R = quat_to_matrix(middle)
    thrust = np.zeros(3)  # specific force in the world
    for i in range(3):
        for k in range(3):
            mean = 0.5 * (force_before[k] + force[k])
            thrust[i] += R[i, k] * (mean - state.accelerometer_bias[k])
    phi = np.empty(SIZE - 9)
    for i in range(SIZE - 9):
        phi[i] = np.exp(-dt * decay[i])
    _advance_mean(state, quat_multiply(middle, half), thrust, dt, gravity)
    _decay(state, variance, phi)
    _advance_covariance(state.covariance, R, thrust, dt, phi)
    if state.cross.shape[0] > 0:
        _advance_cross(state.cross, R, thrust, dt, phi)
    _add_noise(state.covariance, dt, phi, gyro, accelerometer, variance)
    for i in range(6):
        if state.excess[i] > 0.0:
            _add_excess(state.covariance, R, state.excess, dt, period)
            break


@exact_inner
def _advance_mean(
    state: NavigationState,
    quaternion: Array,
    thrust: Array,
    dt: float,
    gravity: float,
) -> None:
    for i in range(3):
        acceleration = thrust[i] + (gravity if i == 2 else 0.0)
        state.position[i] += (state.velocity[i] + 0.5 * acceleration * dt) * dt
        state.velocity[i] += acceleration * dt
    length = np.sqrt(quaternion.dot(quaternion))
    for i in range(4):
        state.quaternion[i] = quaternion[i] / length


@exact_inner
def _decay(state: NavigationState, variance: Array, phi: Array) -> None:
    """Gauss-Markov; an inertial bias beyond `BEYOND` of its deviations has stepped, and stays."""
    for i in range(3):
        if state.gyro_bias[i] ** 2 < BEYOND**2 * variance[i]:
            state.gyro_bias[i] *= phi[i]
        if state.accelerometer_bias[i] ** 2 < BEYOND**2 * variance[3 + i]:
            state.accelerometer_bias[i] *= phi[3 + i]
        state.compass_bias[i] *= phi[6 + i]
    for i in range(SIZE - FURTHER):
        state.further[i] *= phi[9 + i]


@exact_inner
def _advance_covariance(P: Array, R: Array, thrust: Array, dt: float, phi: Array) -> None:
    """P <- F P F^T: F on the columns of the symmetric P, then on those of the transpose."""
    work = np.empty((3, 3, SIZE))
    _transition(P, R, thrust, dt, phi, work)
    for i in range(SIZE):
        for j in range(i):
            P[i, j], P[j, i] = P[j, i], P[i, j]
    _transition(P, R, thrust, dt, phi, work)
    for i in range(SIZE):
        for j in range(i):
            mean = 0.5 * (P[i, j] + P[j, i])
            P[i, j] = mean
            P[j, i] = mean


@exact_inner
def _advance_cross(C: Array, R: Array, thrust: Array, dt: float, phi: Array) -> None:
    """C <- C F^T, of a target (see `target.py`), which stays where it is.

    In a matrix of the size for which `_transition` is compiled; the columns that are too many are
    zero.
    """
    E, work = np.zeros((SIZE, SIZE)), np.empty((3, 3, SIZE))
    for i in range(C.shape[0]):
        for j in range(SIZE):
            E[j, i] = C[i, j]
    _transition(E, R, thrust, dt, phi, work)
    for i in range(C.shape[0]):
        for j in range(SIZE):
            C[i, j] = E[j, i]


@exact_inner
def _add_noise(
    P: Array, dt: float, phi: Array, gyro: float, accelerometer: float, variance: Array
) -> None:
    """P <- P + Q."""
    for i in range(3):
        P[i, i] += accelerometer * dt**3 / 3.0
        P[i, 3 + i] += 0.5 * accelerometer * dt**2
        P[3 + i, i] += 0.5 * accelerometer * dt**2
        P[3 + i, 3 + i] += accelerometer * dt
        P[6 + i, 6 + i] += gyro * dt
    for i in range(SIZE - 9):
        P[9 + i, 9 + i] += (1.0 - phi[i] * phi[i]) * variance[i]


@exact_inner
def _add_excess(P: Array, R: Array, excess: Array, dt: float, period: float) -> None:
    """P <- P + Q of the noise that the unit states beyond the vehicle file, by its axes."""
    for i in range(3):
        for j in range(3):
            gyro, accelerometer = 0.0, 0.0
            for k in range(3):
                gyro += R[i, k] * excess[k] * R[j, k] * period
                accelerometer += R[i, k] * excess[3 + k] * R[j, k] * period
            P[i, j] += accelerometer * dt**3 / 3.0
            P[i, 3 + j] += 0.5 * accelerometer * dt**2
            P[3 + i, j] += 0.5 * accelerometer * dt**2
            P[3 + i, 3 + j] += accelerometer * dt
            P[6 + i, 6 + j] += gyro * dt


@exact_inner
def _transition(E: Array, R: Array, thrust: Array, dt: float, phi: Array, work: Array) -> None:
    """Carry error states over the interval in place, E <- F E: one in each of SIZE columns.

    Row by row, which numba makes vector instructions of.
    """
    gyro, middle, a = work[0], work[1], work[2]
    for i in range(3):
        for j in range(SIZE):  # the biases in the world; what the accelerometer's makes
            gyro[i, j] = R[i, 0] * E[9, j] + R[i, 1] * E[10, j] + R[i, 2] * E[11, j]
            a[i, j] = -(R[i, 0] * E[12, j] + R[i, 1] * E[13, j] + R[i, 2] * E[14, j])
        for j in range(SIZE):
            middle[i, j] = E[6 + i, j] - 0.5 * dt * gyro[i, j]
    # the attitude error in the middle of the interval turns the specific force
    for i in range(3):
        k, m = (i + 1) % 3, (i + 2) % 3
        for j in range(SIZE):
            a[i, j] += middle[k, j] * thrust[m] - middle[m, j] * thrust[k]
    for i in range(3):
        for j in range(SIZE):
            E[i, j] += (E[3 + i, j] + 0.5 * dt * a[i, j]) * dt
            E[3 + i, j] += a[i, j] * dt
            E[6 + i, j] -= gyro[i, j] * dt
    for i in range(SIZE - 9):
        if phi[i] != 1.0:
            for j in range(SIZE):
                E[9 + i, j] *= phi[i]
