"""The pose of the work object as part of the filter's state, beside the vehicle's own.

Its error e_T = (dp_T, dtheta_T) is that of a constant, in the axes of map_ned. It is correlated
with the error e of the rest: a target that is first seen is as far off in the map as the vehicle
is, and then the vehicle is known relative to it, wherever the map has drifted. `cross` is
E[e_T e^T] and `target_covariance` E[e_T e_T^T]; a vehicle without a marker has none of them, in
arrays of no rows.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat
from uvms_observer.navigation.arrays import transposed
from uvms_observer.navigation.state import SIZE, NavigationState

TARGET_SIZE = 6


def with_target(
    state: NavigationState, position: Array, quaternion: Array, variance: Array
) -> NavigationState:
    """The state with a target whose pose is known independently of the vehicle's.

    Args:
        position: (3,) m, map_ned.
        quaternion: (4,) target to map_ned; zeros where it has never been seen and nothing is known.
        variance: (6,) m^2 and rad^2.
    """
    return state._replace(
        target=np.concatenate([position, quaternion]),
        cross=np.zeros((TARGET_SIZE, SIZE)),
        target_covariance=np.diag(variance),
    )


@exact_inner
def is_known(state: NavigationState) -> bool:
    """Whether the target was ever seen, or its pose is given."""
    q = state.target[3:7]
    return q.dot(q) > 0.5


@exact_inner
def correct_target(
    state: NavigationState, H: Array, gain: Array, N: Array, residual: Array
) -> None:
    """What a measurement H of the vehicle says about the target, by what they have in common.

    With K_T = C H^T S^-1, and whatever gain K, here transposed (m, SIZE), corrects the vehicle:

        e_T = K_T r,  C <- (C - K_T H P) (I - K H)^T + K_T N K^T,
        P_T <- P_T - K_T H C^T - C H^T K_T^T + K_T S K_T^T.

    Called before the vehicle's own covariance P is corrected.
    """
    if state.target.shape[0] == 0 or not is_known(state):
        return
    HP, CHt = H @ state.covariance, state.cross @ transposed(H)
    S = HP @ transposed(H)
    for i in range(N.shape[0]):
        for j in range(N.shape[0]):
            S[i, j] += N[i, j]
    own = CHt @ np.linalg.inv(S)
    less, more = own @ transposed(CHt), (own @ S) @ transposed(own)
    P = state.target_covariance
    for i in range(TARGET_SIZE):
        for j in range(i + 1):
            mean = P[i, j] - less[i, j] - less[j, i] + 0.5 * (more[i, j] + more[j, i])
            P[i, j] = mean
            P[j, i] = mean
    _correct_cross(state.cross, H, gain, own @ HP, own @ N)
    move_target(state, own @ residual)


@exact_inner
def _correct_cross(C: Array, H: Array, gain: Array, told: Array, noise: Array) -> None:
    """C <- (C - told) (I - K H)^T + noise K^T, in place."""
    for i in range(TARGET_SIZE):
        for j in range(SIZE):
            C[i, j] -= told[i, j]
    left = C @ transposed(H)
    for i in range(TARGET_SIZE):
        for j in range(H.shape[0]):
            left[i, j] -= noise[i, j]
    change = left @ gain
    for i in range(TARGET_SIZE):
        for j in range(SIZE):
            C[i, j] -= change[i, j]


@exact_inner
def move_target(state: NavigationState, e: Array) -> None:
    """Add an error (6,) to the target's pose; the turn is about the axes of map_ned."""
    turned = quat_multiply(rotation_vector_to_quat(e[3:6]), state.target[3:7])
    length = np.sqrt(turned.dot(turned))
    for i in range(3):
        state.target[i] += e[i]
    for i in range(4):
        state.target[3 + i] = turned[i] / length
