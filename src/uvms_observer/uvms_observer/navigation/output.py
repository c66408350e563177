"""Odometry of the body origin from the state, which is that of the IMU.

With d from the IMU to the body origin (body axes) and w = w_m - b_g:

    p_o = p + R d,   v_o = R^T v + w x d,   omega = w.
"""

import numpy as np
from numba import njit

from uvms_core.signals import Array, Odometry
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.state import SIZE, NavigationState


@njit(cache=True)
def _pose(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Position (3,) of the body origin and pose covariance (6, 6), both about map_ned axes."""
    offset = quat_to_matrix(state.quaternion) @ lever
    J = np.zeros((6, SIZE))
    for i in range(3):
        J[i, i] = 1.0
        J[3 + i, 6 + i] = 1.0
    J[:3, 6:9] = -skew(offset)
    covariance = J @ state.covariance @ np.ascontiguousarray(J.T)
    return state.position + offset, 0.5 * (covariance + covariance.T)


@njit(cache=True)
def _twist(
    state: NavigationState, lever: Array, rate: Array, rate_variance: float
) -> tuple[Array, Array]:
    """Velocity nu (6,) of the body origin over ground and its covariance (6, 6), body frame.

    The rate is the gyro's, so that its noise is part of the result, of the velocity by the lever.
    """
    R = quat_to_matrix(state.quaternion)
    arm = skew(lever)
    omega = rate - state.gyro_bias
    nu = np.empty(6)
    nu[:3] = R.T @ state.velocity - arm @ omega
    nu[3:] = omega
    J = np.zeros((6, SIZE))
    J[:3, 3:6] = R.T
    J[:3, 6:9] = R.T @ skew(state.velocity)
    G = np.zeros((6, 3))  # by the rate's error, which is -db_g - n
    G[:3] = -arm
    G[3:] = np.eye(3)
    J[:, 9:12] = -G
    covariance = J @ state.covariance @ np.ascontiguousarray(J.T)
    covariance += rate_variance * (G @ np.ascontiguousarray(G.T))
    return nu, 0.5 * (covariance + covariance.T)


def odometry(
    stamp: int, state: NavigationState, lever: Array, rate: Array, rate_variance: float
) -> Odometry:
    """The estimate at the body origin; fresh arrays."""
    position, pose_covariance = _pose(state, lever)
    nu, twist_covariance = _twist(state, lever, rate, rate_variance)
    return Odometry(stamp, position, state.quaternion.copy(), nu, pose_covariance, twist_covariance)
