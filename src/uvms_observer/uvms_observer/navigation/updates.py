"""One correction per sensor: expected reading, noise, gate and gain in one call.

Each corrects the state in place, or leaves it when the residual is beyond the gate, and returns the
residual's squared Mahalanobis distance.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation import measurements
from uvms_observer.navigation.correction import correct, transposed
from uvms_observer.navigation.state import NavigationState

attitude, velocity = measurements.attitude, measurements.velocity
depth, position = measurements.depth, measurements.position


@exact_kernel
def correct_attitude(
    state: NavigationState, measured: Array, variance: Array, gate: float
) -> float:
    """Gyrocompass: quaternion (4,), variances (3,) rad^2 about the body axes."""
    residual, H = attitude(state, measured)
    R = quat_to_matrix(state.quaternion)
    scaled = np.empty((3, 3))
    for i in range(3):
        for k in range(3):
            scaled[i, k] = R[i, k] * variance[k]
    return correct(state, H, residual, scaled @ transposed(R), gate)


@exact_kernel
def correct_velocity(
    state: NavigationState,
    measured: Array,
    variance: float,
    lever: Array,
    rate: Array,
    rate_variance: float,
    gate: float,
) -> float:
    """DVL: velocity (3,) m/s in body axes; the noise of the gyro reads through the lever arm."""
    residual, H = velocity(state, lever, rate)
    _subtract_from(measured, residual)
    arm = skew(lever)
    N = arm @ transposed(arm)
    for i in range(3):
        for k in range(3):
            N[i, k] = (variance if i == k else 0.0) + rate_variance * N[i, k]
    return correct(state, H, residual, N, gate)


@exact_kernel
def correct_depth(
    state: NavigationState, measured: float, variance: float, lever: Array, gate: float
) -> float:
    """Pressure sensor: its depth in m."""
    residual, H = depth(state, lever)
    residual[0] = measured - residual[0]
    N = np.empty((1, 1))
    N[0, 0] = variance
    return correct(state, H, residual, N, gate)


@exact_kernel
def correct_position(
    state: NavigationState, measured: Array, variance: Array, lever: Array, gate: float
) -> float:
    """GPS: antenna (3,) m in map_ned, variances (3,) m^2 north, east, down."""
    residual, H = position(state, lever)
    _subtract_from(measured, residual)
    N = np.zeros((3, 3))
    for i in range(3):
        N[i, i] = variance[i]
    return correct(state, H, residual, N, gate)


@exact_inner
def _subtract_from(measured: Array, expected: Array) -> None:
    """Expected becomes the residual (3,)."""
    for i in range(3):
        expected[i] = measured[i] - expected[i]
