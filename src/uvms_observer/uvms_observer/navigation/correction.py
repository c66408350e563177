"""The Kalman correction by one measurement: gate, gain, Joseph form, error added to the state.

    S = H P H^T + N,  d^2 = r^T S^-1 r,  K = P H^T S^-1,
    e = K r,  P <- (I - K H) P (I - K H)^T + K N K^T,  state <- state (+) e.

The Joseph form holds for any gain and keeps P positive semidefinite under rounding. The tests
compare it with the same in plain numpy.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import (
    quat_multiply,
    quat_normalize,
    rotation_vector_to_quat,
)
from uvms_observer.navigation.arrays import covariance_of, product, subtract_products
from uvms_observer.navigation.state import (
    DVL_MISALIGNMENT,
    DVL_SCALE,
    FURTHER,
    SIZE,
    WIDEST,
    NavigationState,
)
from uvms_observer.navigation.target import correct_target

TINY = 1e-18
"""Added to the variances of scale and misalignment (rad^2), which may be 0."""


@exact_kernel
def correct(
    state: NavigationState,
    H: Array,
    residual: Array,
    N: Array,
    gate: float,
    is_fix: bool = False,
) -> float:
    """Correct the state in place, unless the residual's distance is beyond the gate.

    Args:
        H: (m, SIZE) derivative of the measurement by the error state.
        residual: (m,) measured minus expected.
        N: (m, m) covariance of the measurement's noise.
        gate: largest d^2 that is accepted.
        is_fix: whether a position is measured, which tells scale and misalignment of the DVL. Other
            samples leave those as they are and are weighed as if they were known, and the
            covariance accounts for their not being so (as in Schmidt's filter): through
            accelerations they are known worse than from mounting.

    Returns:
        d^2, the squared Mahalanobis distance of the residual: above `gate` nothing was changed but
        the innovation that the state keeps.
    """
    HP = product(H, state.covariance)
    S = covariance_of(HP, H, N)
    keep_innovation(state.innovation, residual, N, S)
    weights = inverse(S)
    distance = _squared(residual, weights)
    if not distance <= gate:
        return distance
    if is_fix:
        gain = product(weights, HP)
    else:
        known = _of_known_mounting(state.covariance, HP)
        gain = product(inverse(covariance_of(known, H, N)), known)
    if state.target.shape[0] > 0:
        correct_target(state, H, gain, N, residual)
    _correct_covariance(state.covariance, gain, H, HP, N)
    add_error(state, _weighted(residual, gain))
    return distance


@exact_inner
def inverse(S: Array) -> Array:
    """Of a small symmetric positive definite matrix, by elimination."""
    m = S.shape[0]
    left, out = S.copy(), np.zeros((m, m))
    for i in range(m):
        out[i, i] = 1.0
    for i in range(m):
        pivot = 1.0 / left[i, i]
        for k in range(m):
            left[i, k] *= pivot
            out[i, k] *= pivot
        for row in range(m):
            factor = left[row, i]
            if row != i and factor != 0.0:
                for k in range(m):
                    left[row, k] -= factor * left[i, k]
                    out[row, k] -= factor * out[i, k]
    return out


@exact_inner
def _squared(residual: Array, weights: Array) -> float:
    total = 0.0
    for i in range(weights.shape[0]):
        for j in range(weights.shape[0]):
            total += residual[i] * weights[i, j] * residual[j]
    return total


@exact_inner
def _weighted(residual: Array, gain: Array) -> Array:
    """K r (SIZE,), with the gain's transpose (m, SIZE)."""
    e = np.zeros(SIZE)
    for i in range(gain.shape[0]):
        for k in range(SIZE):
            e[k] += residual[i] * gain[i, k]
    return e


@exact_inner
def keep_innovation(innovation: Array, residual: Array, N: Array, S: Array) -> None:
    """Note a residual with noise N and covariance S, for the gate (see `NavigationState`)."""
    for i in range(WIDEST):
        for j in range(3):
            innovation[j, i] = 0.0
        if i < N.shape[0]:
            innovation[0, i] = residual[i]
            innovation[1, i] = np.sqrt(N[i, i])
            innovation[2, i] = np.sqrt(S[i, i])


@exact_inner
def _place(i: int) -> int:
    """In the error state, of the DVL's scale and misalignment."""
    return DVL_SCALE if i == 0 else DVL_MISALIGNMENT + i - 1


@exact_inner
def _of_known_mounting(P: Array, HP: Array) -> Array:
    """H P (m, SIZE) by the covariance of all else, given the DVL's scale and misalignment k.

    P_x - P_xk P_kk^-1 P_kx; those themselves are left as they are.
    """
    within = np.empty((4, 4))
    for i in range(4):
        for j in range(4):
            within[i, j] = P[_place(i), _place(j)]
        within[i, i] += TINY
    weights, told, known = inverse(within), np.empty(4), HP.copy()
    for row in range(HP.shape[0]):
        for i in range(4):
            told[i] = 0.0
            for k in range(4):
                told[i] += weights[i, k] * HP[row, _place(k)]
        s, x, y, z = told[0], told[1], told[2], told[3]
        for j in range(SIZE):
            known[row, j] = (
                known[row, j]
                - s * P[DVL_SCALE, j]
                - x * P[DVL_MISALIGNMENT, j]
                - y * P[DVL_MISALIGNMENT + 1, j]
                - z * P[DVL_MISALIGNMENT + 2, j]
            )
        for i in range(4):
            known[row, _place(i)] = 0.0
    return known


@exact_inner
def _correct_covariance(P: Array, gain: Array, H: Array, HP: Array, N: Array) -> None:
    """(I - K H) P (I - K H)^T + K N K^T, first from the left, then from the right.

    `gain` is the transpose of K, (m, SIZE). The right side takes the matrix that the left one has
    left, which keeps what it has gained in precision. In between, P holds the transpose of the
    left product, so that all goes by rows.
    """
    subtract_products(P, HP, gain)
    right, noise = product(H, P), product(N, gain)
    for a in range(N.shape[0]):
        for i in range(SIZE):
            right[a, i] -= noise[a, i]
    subtract_products(P, gain, right)
    for i in range(SIZE):
        for j in range(i):
            P[i, j] = P[j, i]


@exact_inner
def add_error(state: NavigationState, e: Array) -> None:
    """Add the error, state <- state (+) e; the attitude error turns about the axes of map_ned."""
    turn = rotation_vector_to_quat(e[6:9])
    turned = quat_normalize(quat_multiply(turn, state.quaternion))
    for i in range(3):
        state.position[i] += e[i]
        state.velocity[i] += e[3 + i]
        state.gyro_bias[i] += e[9 + i]
        state.accelerometer_bias[i] += e[12 + i]
        state.compass_bias[i] += e[15 + i]
    for i in range(SIZE - FURTHER):
        state.further[i] += e[FURTHER + i]
    for i in range(4):
        state.quaternion[i] = turned[i]
