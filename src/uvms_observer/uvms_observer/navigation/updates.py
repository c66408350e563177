"""One correction per sensor: expected reading, noise, gate and gain in one call.

Each corrects the state in place, or leaves it when the residual is beyond the gate, and returns the
residual's squared Mahalanobis distance.
"""

import numpy as np
from numba import njit

from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation import measurements
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.state import NavigationState

attitude, velocity = measurements.attitude, measurements.velocity
depth, position = measurements.depth, measurements.position


@njit(cache=True)
def correct_attitude(
    state: NavigationState, measured: Array, variance: Array, gate: float
) -> float:
    """Gyrocompass: quaternion (4,), variances (3,) rad^2 about the body axes."""
    residual, H = attitude(state, measured)
    R = quat_to_matrix(state.quaternion)
    return correct(state, H, residual, (R * variance) @ np.ascontiguousarray(R.T), gate)


@njit(cache=True)
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
    expected, H = velocity(state, lever, rate)
    arm = skew(lever)
    N = variance * np.eye(3) + rate_variance * (arm @ np.ascontiguousarray(arm.T))
    return correct(state, H, measured - expected, N, gate)


@njit(cache=True)
def correct_depth(
    state: NavigationState, measured: float, variance: float, lever: Array, gate: float
) -> float:
    """Pressure sensor: its depth in m."""
    expected, H = depth(state, lever)
    return correct(state, H, measured - expected, variance * np.eye(1), gate)


@njit(cache=True)
def correct_position(
    state: NavigationState, measured: Array, variance: Array, lever: Array, gate: float
) -> float:
    """GPS: antenna (3,) m in map_ned, variances (3,) m^2 north, east, down."""
    expected, H = position(state, lever)
    return correct(state, H, measured - expected, np.diag(variance), gate)
