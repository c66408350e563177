"""Kernels of sensors that measure where they are: GPS, acoustic positioning."""

import numpy as np
from numba import njit

from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.state import SIZE, NavigationState


@njit(cache=True)
def position(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Position of the sensor (3,) m, map_ned, p + R d, and H."""
    offset = quat_to_matrix(state.quaternion) @ lever
    H = np.zeros((3, SIZE))
    for i in range(3):
        H[i, i] = 1.0
    H[:, 6:9] = -skew(offset)
    return state.position + offset, H


@njit(cache=True)
def correct_position(
    state: NavigationState, measured: Array, variance: Array, lever: Array, gate: float
) -> float:
    """Position of the sensor (3,) m in map_ned, variances (3,) m^2 north, east, down."""
    expected, H = position(state, lever)
    return correct(state, H, measured - expected, np.diag(variance), gate)
