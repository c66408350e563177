"""Odometry of the body origin from the state, which is that of the IMU.

With d from the IMU to the body origin (body axes) and w = w_m - b_g:

    p_o = p + R d,   v_o = R^T v + w x d,   omega = w.
"""

import numpy as np

from uvms_core.signals import Array, Odometry
from uvms_dynamics.kernels import products
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.arrays import body_rate, covariance_of, product, transposed
from uvms_observer.navigation.state import SIZE, Fields, NavigationState


@exact_inner
def _pose(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Position (3,) of the body origin and pose covariance (6, 6), both about map_ned axes."""
    position = products.product(quat_to_matrix(state.quaternion), lever)
    J, arm = np.zeros((6, SIZE)), skew(position)
    for i in range(3):
        J[i, i] = 1.0
        J[3 + i, 6 + i] = 1.0
        for k in range(3):
            J[i, 6 + k] = -arm[i, k]
        position[i] += state.position[i]
    covariance = covariance_of(product(J, state.covariance), J, np.zeros((6, 6)))
    _symmetrize(covariance)
    return position, covariance


@exact_inner
def _twist(
    state: NavigationState, lever: Array, rate: Array, rate_variance: float
) -> tuple[Array, Array]:
    """Velocity nu (6,) of the body origin over ground and its covariance (6, 6), body frame.

    The rate is the gyro's, so that its noise is part of the result, of the velocity by the lever.
    """
    R = quat_to_matrix(state.quaternion)
    arm, turned = skew(lever), product(transposed(R), skew(state.velocity))
    omega = body_rate(state, rate)
    velocity = products.transposed_product(R, state.velocity)
    swing = products.product(arm, omega)
    nu, J = np.empty(6), np.zeros((6, SIZE))
    G = np.zeros((6, 3))  # by the rate's error, which is -db_g - n
    for i in range(3):
        nu[i], nu[3 + i] = velocity[i] - swing[i], omega[i]
        G[3 + i, i] = 1.0
        J[3 + i, 9 + i] = -1.0
        for k in range(3):
            J[i, 3 + k] = R[k, i]
            J[i, 6 + k] = turned[i, k]
            G[i, k], J[i, 9 + k] = -arm[i, k], arm[i, k]
    noise = product(G, transposed(G))
    for i in range(6):
        for k in range(6):
            noise[i, k] *= rate_variance
            for m in range(3):
                noise[i, k] += G[i, m] * state.excess[m] * G[k, m]
    covariance = covariance_of(product(J, state.covariance), J, noise)
    _symmetrize(covariance)
    return nu, covariance


@exact_inner
def _symmetrize(matrix: Array) -> None:
    """Make both triangles the mean of the two."""
    for i in range(matrix.shape[0]):
        for k in range(i):
            mean = 0.5 * (matrix[i, k] + matrix[k, i])
            matrix[i, k] = mean
            matrix[k, i] = mean


@exact_kernel
def _estimate(
    fields: Fields, lever: Array, rate: Array, rate_variance: float
) -> tuple[Array, Array, Array, Array, Array]:
    """The fields of an `Odometry` but the stamp, in its order."""
    state = NavigationState(*fields)
    position, pose_covariance = _pose(state, lever)
    nu, twist_covariance = _twist(state, lever, rate, rate_variance)
    return position, state.quaternion.copy(), nu, pose_covariance, twist_covariance


def odometry(
    stamp: int, state: NavigationState, lever: Array, rate: Array, rate_variance: float
) -> Odometry:
    """The estimate at the body origin; fresh arrays."""
    return Odometry(stamp, *_estimate(tuple(state), lever, rate, rate_variance))
