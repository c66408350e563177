"""The poses of work objects as part of the filter's state, beside the vehicle's own.

The error of each, e_T = (dp_T, dtheta_T), is that of a constant, in the axes of map_ned. It is
correlated with the error e of the rest: a target that is first seen is as far off in the map as the
vehicle is, and then the vehicle is known relative to it, wherever the map has drifted. With the
errors of all targets below one another in e_T, `cross` is E[e_T e^T] and `target_covariance`
E[e_T e_T^T]; a vehicle without a marker has none of them, in arrays of no rows. A target that has
never been seen, and of which nothing is known, has zeros for its pose and in both.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner
from uvms_dynamics.kernels.rotations import quat_multiply, rotation_vector_to_quat
from uvms_observer.navigation.arrays import transposed
from uvms_observer.navigation.state import SIZE, NavigationState

TARGET_SIZE = 6
POSE = 7
"""Place of each in `NavigationState.target`: position and quaternion."""
MOST_TARGETS = 4
"""The work of a correction grows with the square of their number."""


def with_target(
    state: NavigationState, position: Array, quaternion: Array, variance: Array
) -> NavigationState:
    """The state with a further target, whose pose is known independently of all else.

    Args:
        position: (3,) m, map_ned.
        quaternion: (4,) target to map_ned; zeros where it has never been seen and nothing is known.
        variance: (6,) m^2 and rad^2.
    """
    before = len(state.cross)
    covariance = np.zeros((before + TARGET_SIZE, before + TARGET_SIZE))
    covariance[:before, :before] = state.target_covariance
    covariance[before:, before:] = np.diag(variance)
    return state._replace(
        target=np.concatenate([state.target, position, quaternion]),
        cross=np.concatenate([state.cross, np.zeros((TARGET_SIZE, SIZE))]),
        target_covariance=covariance,
    )


@exact_inner
def is_known(state: NavigationState, index: int) -> bool:
    """Whether this target was ever seen, or its pose is given."""
    q = state.target[POSE * index + 3 : POSE * (index + 1)]
    return q.dot(q) > 0.5


@exact_inner
def correct_target(
    state: NavigationState, H: Array, gain: Array, N: Array, residual: Array
) -> None:
    """What a measurement H of the vehicle says about the targets, by what they have in common.

    With K_T = C H^T S^-1, and whatever gain K, here transposed (m, SIZE), corrects the vehicle:

        e_T = K_T r,  C <- (C - K_T H P) (I - K H)^T + K_T N K^T,
        P_T <- P_T - K_T H C^T - C H^T K_T^T + K_T S K_T^T.

    Called before the vehicle's own covariance P is corrected, where there are targets.
    """
    HP, CHt = H @ state.covariance, state.cross @ transposed(H)
    S = HP @ transposed(H)
    for i in range(N.shape[0]):
        for j in range(N.shape[0]):
            S[i, j] += N[i, j]
    own = CHt @ np.linalg.inv(S)
    less, more = own @ transposed(CHt), (own @ S) @ transposed(own)
    P = state.target_covariance
    for i in range(P.shape[0]):
        for j in range(i + 1):
            mean = P[i, j] - less[i, j] - less[j, i] + 0.5 * (more[i, j] + more[j, i])
            P[i, j] = mean
            P[j, i] = mean
    _correct_cross(state.cross, H, gain, own @ HP, own @ N)
    move_targets(state, own @ residual)


@exact_inner
def _correct_cross(C: Array, H: Array, gain: Array, told: Array, noise: Array) -> None:
    """C <- (C - told) (I - K H)^T + noise K^T, in place."""
    for i in range(C.shape[0]):
        for j in range(SIZE):
            C[i, j] -= told[i, j]
    left = C @ transposed(H)
    for i in range(C.shape[0]):
        for j in range(H.shape[0]):
            left[i, j] -= noise[i, j]
    change = left @ gain
    for i in range(C.shape[0]):
        for j in range(SIZE):
            C[i, j] -= change[i, j]


@exact_inner
def move_targets(state: NavigationState, e: Array) -> None:
    """Add errors (6 k,) to the poses that are known; turns are about the axes of map_ned."""
    for index in range(state.cross.shape[0] // TARGET_SIZE):
        if not is_known(state, index):
            continue
        first, place = TARGET_SIZE * index, POSE * index
        turn = rotation_vector_to_quat(e[first + 3 : first + 6])
        turned = quat_multiply(turn, state.target[place + 3 : place + 7])
        length = np.sqrt(turned.dot(turned))
        for i in range(3):
            state.target[place + i] += e[first + i]
        for i in range(4):
            state.target[place + 3 + i] = turned[i] / length
