"""The Kalman correction by one measurement: gate, gain, Joseph form, error added to the state.

    S = H P H^T + N,  d^2 = r^T S^-1 r,  K = P H^T S^-1,
    e = K r,  P <- (I - K H) P (I - K H)^T + K N K^T,  state <- state (+) e.

The Joseph form holds for any gain and keeps P positive semidefinite under rounding. The tests
compare it with the same in plain numpy.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat
from uvms_observer.navigation.arrays import transposed
from uvms_observer.navigation.state import DVL_MISALIGNMENT, FURTHER, SIZE, WIDEST, NavigationState

TINY = 1e-18
"""rad^2, added to the variance of a misalignment that may be 0."""


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
        is_fix: whether a position is measured, from which the DVL's misalignment can be told.
            Other samples are weighed as if that were known, and the covariance accounts for its not
            being so: through accelerations they would estimate it, worse than mounting does.

    Returns:
        d^2, the squared Mahalanobis distance of the residual: above `gate` nothing was changed but
        the innovation that the state keeps.
    """
    PHt = state.covariance @ transposed(H)
    S = H @ PHt
    for i in range(N.shape[0]):
        for j in range(N.shape[0]):
            S[i, j] += N[i, j]
    for i in range(N.shape[0], WIDEST):
        for j in range(3):
            state.innovation[j, i] = 0.0
    for i in range(N.shape[0]):
        state.innovation[0, i] = residual[i]
        state.innovation[1, i] = np.sqrt(N[i, i])
        state.innovation[2, i] = np.sqrt(S[i, i])
    S_inverse = np.linalg.inv(S)
    distance = residual.dot(S_inverse @ residual)
    if not distance <= gate:
        return distance
    K = PHt @ S_inverse if is_fix else _gain_of_known_mounting(state.covariance, PHt, H, N)
    _correct_covariance(state.covariance, K, H, N)
    _add_error(state, K @ residual)
    return distance


@exact_inner
def _gain_of_known_mounting(P: Array, PHt: Array, H: Array, N: Array) -> Array:
    """Gain (SIZE, m) by the covariance of all else, given the DVL's misalignment.

    P_x - G P_mx with G = P_xm P_mm^-1; the misalignment itself is left as it is.
    """
    m = N.shape[0]
    within = np.empty((3, 3))
    for i in range(3):
        for j in range(3):
            within[i, j] = P[DVL_MISALIGNMENT + i, DVL_MISALIGNMENT + j]
        within[i, i] += TINY
    inverse = np.linalg.inv(within)
    known = np.zeros((SIZE, m))
    told = np.zeros((3, m))  # P_mm^-1 (P H^T)_m
    for i in range(3):
        for j in range(m):
            for k in range(3):
                told[i, j] += inverse[i, k] * PHt[DVL_MISALIGNMENT + k, j]
    for i in range(SIZE):
        if not DVL_MISALIGNMENT <= i < DVL_MISALIGNMENT + 3:
            for j in range(m):
                known[i, j] = PHt[i, j]
                for k in range(3):
                    known[i, j] -= P[i, DVL_MISALIGNMENT + k] * told[k, j]
    S = H @ known
    for i in range(m):
        for j in range(m):
            S[i, j] += N[i, j]
    return known @ np.linalg.inv(S)


@exact_inner
def linearization_point(
    state: NavigationState, H: Array, residual: Array, N: Array
) -> tuple[NavigationState, Array]:
    """The state (+) K r, with arrays of its own, and K r: where an iterated filter linearizes.

    Jazwinski, *Stochastic Processes and Filtering Theory* (1970), sec. 8.3.
    """
    PHt = state.covariance @ transposed(H)
    S = H @ PHt
    for i in range(N.shape[0]):
        for j in range(N.shape[0]):
            S[i, j] += N[i, j]
    e = PHt @ (np.linalg.inv(S) @ residual)
    point = NavigationState(
        state.position.copy(),
        state.velocity.copy(),
        state.quaternion.copy(),
        state.gyro_bias.copy(),
        state.accelerometer_bias.copy(),
        state.compass_bias.copy(),
        state.further.copy(),
        state.covariance,
        state.innovation,
    )
    _add_error(point, e)
    return point, e


@exact_inner
def _correct_covariance(P: Array, K: Array, H: Array, N: Array) -> None:
    left = K @ H
    for i in range(SIZE):
        for j in range(SIZE):
            left[i, j] = (1.0 if i == j else 0.0) - left[i, j]
    kept = (left @ P) @ transposed(left)
    added = (K @ N) @ transposed(K)
    for i in range(SIZE):
        for j in range(i + 1):
            mean = 0.5 * ((kept[i, j] + added[i, j]) + (kept[j, i] + added[j, i]))
            P[i, j] = mean
            P[j, i] = mean


@exact_inner
def _add_error(state: NavigationState, e: Array) -> None:
    """Add the error, state <- state (+) e; the attitude error turns about the axes of map_ned."""
    turned = quat_multiply(rotation_vector_to_quat(e[6:9]), state.quaternion)
    length = np.sqrt(turned.dot(turned))
    for i in range(3):
        state.position[i] += e[i]
        state.velocity[i] += e[3 + i]
        state.gyro_bias[i] += e[9 + i]
        state.accelerometer_bias[i] += e[12 + i]
        state.compass_bias[i] += e[15 + i]
    for i in range(SIZE - FURTHER):
        state.further[i] += e[FURTHER + i]
    for i in range(4):
        state.quaternion[i] = turned[i] / length
