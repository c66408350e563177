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
from uvms_dynamics.kernels.rotations import (
    quat_multiply,
    quat_normalize,
    quat_to_matrix,
    rotation_vector_to_quat,
)
from uvms_observer.navigation.state import ATTITUDE, FURTHER, SIZE, Fields, NavigationState

BEYOND = 5.0
MOVED = ATTITUDE.stop
"""Of the error states, the first ones, which others move; those after them only fade."""


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
    for i in range(SIZE - 9):  # many are the same
        is_new = i == 0 or decay[i] != decay[i - 1]
        phi[i] = np.exp(-dt * decay[i]) if is_new else phi[i - 1]
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
    unit = quat_normalize(quaternion)
    for i in range(4):
        state.quaternion[i] = unit[i]


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
    """P <- F P F^T of the symmetric P: F on its rows, then on its columns.

    Of the columns only those of the states that move; the others are the rows' mirror image.
    """
    for i in range(SIZE):
        _carry(P, i, R, thrust, dt)
    columns = P.T
    for j in range(MOVED):
        _carry(columns, j, R, thrust, dt)
    for i in range(MOVED):
        for j in range(i):
            mean = 0.5 * (P[i, j] + P[j, i])
            P[i, j] = mean
            P[j, i] = mean
    for i in range(SIZE - MOVED):
        for j in range(MOVED):
            P[MOVED + i, j] *= phi[i]
            P[j, MOVED + i] = P[MOVED + i, j]
        for j in range(SIZE - MOVED):
            P[MOVED + i, MOVED + j] *= phi[i] * phi[j]


@exact_inner
def _advance_cross(C: Array, R: Array, thrust: Array, dt: float, phi: Array) -> None:
    """C <- C F^T, of a target (see `target.py`), which stays where it is."""
    for i in range(C.shape[0]):
        _carry(C, i, R, thrust, dt)
        for k in range(SIZE - MOVED):
            C[i, MOVED + k] *= phi[k]


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
                gyro += R[i, k] * R[j, k] * (excess[k] * period)
                accelerometer += R[i, k] * R[j, k] * (excess[3 + k] * period)
            P[i, j] += accelerometer * dt**3 / 3.0
            P[i, 3 + j] += 0.5 * accelerometer * dt**2
            P[3 + i, j] += 0.5 * accelerometer * dt**2
            P[3 + i, 3 + j] += accelerometer * dt
            P[6 + i, 6 + j] += gyro * dt


@exact_inner
def _carry(E: Array, i: int, R: Array, thrust: Array, dt: float) -> None:
    """Carry the error state in row i over the interval, e <- F e; what only fades is left.

    In scalars: vectors of three would be allocated.
    """
    x, y, z = thrust[0], thrust[1], thrust[2]
    # turned in the world since the begin, by the gyro's bias; the attitude's error in the middle
    turn_x = (R[0, 0] * E[i, 9] + R[0, 1] * E[i, 10] + R[0, 2] * E[i, 11]) * dt
    turn_y = (R[1, 0] * E[i, 9] + R[1, 1] * E[i, 10] + R[1, 2] * E[i, 11]) * dt
    turn_z = (R[2, 0] * E[i, 9] + R[2, 1] * E[i, 10] + R[2, 2] * E[i, 11]) * dt
    tilt_x = E[i, 6] - 0.5 * turn_x
    tilt_y = E[i, 7] - 0.5 * turn_y
    tilt_z = E[i, 8] - 0.5 * turn_z
    # the acceleration's error, by the tilted specific force and by the accelerometer's bias
    a_x = tilt_y * z - tilt_z * y
    a_y = tilt_z * x - tilt_x * z
    a_z = tilt_x * y - tilt_y * x
    a_x -= R[0, 0] * E[i, 12] + R[0, 1] * E[i, 13] + R[0, 2] * E[i, 14]
    a_y -= R[1, 0] * E[i, 12] + R[1, 1] * E[i, 13] + R[1, 2] * E[i, 14]
    a_z -= R[2, 0] * E[i, 12] + R[2, 1] * E[i, 13] + R[2, 2] * E[i, 14]
    E[i, 0] += (E[i, 3] + 0.5 * dt * a_x) * dt
    E[i, 1] += (E[i, 4] + 0.5 * dt * a_y) * dt
    E[i, 2] += (E[i, 5] + 0.5 * dt * a_z) * dt
    E[i, 3] += a_x * dt
    E[i, 4] += a_y * dt
    E[i, 5] += a_z * dt
    E[i, 6] -= turn_x
    E[i, 7] -= turn_y
    E[i, 8] -= turn_z
