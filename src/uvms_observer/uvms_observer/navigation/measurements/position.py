"""Kernels of sensors that measure where they are: GPS, acoustic positioning."""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.products import product
from uvms_dynamics.kernels.rotations import quat_to_matrix, skew
from uvms_observer.navigation.arrays import subtract_from
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.state import SIZE, NavigationState


@exact_inner
def position(state: NavigationState, lever: Array) -> tuple[Array, Array]:
    """Position of the sensor (3,) m, map_ned, p + R d, and H."""
    offset = product(quat_to_matrix(state.quaternion), lever)
    H, arm = np.zeros((3, SIZE)), skew(offset)
    for i in range(3):
        H[i, i] = 1.0
        for k in range(3):
            H[i, 6 + k] = -arm[i, k]
        offset[i] += state.position[i]
    return offset, H


@exact_kernel
def correct_position(
    state: NavigationState, measured: Array, variance: Array, lever: Array, gate: float
) -> float:
    """Position of the sensor (3,) m in map_ned, variances (3,) m^2 north, east, down."""
    residual, H = position(state, lever)
    subtract_from(measured, residual)
    N = np.zeros((3, 3))
    for i in range(3):
        N[i, i] = variance[i]
    return correct(state, H, residual, N, gate, True)
