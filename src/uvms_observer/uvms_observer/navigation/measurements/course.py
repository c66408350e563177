"""Corrections by one angle about the vertical: headings, magnetic or not.

With R = Exp(dtheta) R_hat, a direction c of the world whose horizontal part turns with the vehicle
has its angle about the vertical changed, to first order, by

    a . dtheta,   a = (-c_z c_x, -c_z c_y, c_x^2 + c_y^2) / (c_x^2 + c_y^2):

the vehicle's bow for a heading, the Earth's field for a magnetic one. A bias b of the compass about
the body's z axis adds a . R e_z b.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.state import COMPASS_BIAS, SIZE, Fields, NavigationState

HEADING_BIAS = COMPASS_BIAS.start + 2
"""Index of the compass's bias about the body's z axis."""


@exact_inner
def _turning(c: Array) -> Array:
    """Derivative (3,) of the angle of a direction about the vertical by dtheta."""
    square = c[0] * c[0] + c[1] * c[1]
    a = np.empty(3)
    a[0], a[1], a[2] = -c[2] * c[0] / square, -c[2] * c[1] / square, 1.0
    return a


@exact_inner
def _row(state: NavigationState, R: Array, c: Array, biased: bool) -> Array:
    a, H = _turning(c), np.zeros((1, SIZE))
    for i in range(3):
        H[0, 6 + i] = a[i]
        if biased:
            H[0, HEADING_BIAS] += a[i] * R[i, 2]
    return H


@exact_inner
def _within_half_a_turn(angle: float) -> float:
    return (angle + np.pi) % (2.0 * np.pi) - np.pi


@exact_inner
def heading(state: NavigationState, measured: float, biased: bool) -> tuple[Array, Array]:
    """Residual (1,) rad of a heading, and H (1, n)."""
    R = quat_to_matrix(state.quaternion)
    bow = np.empty(3)
    for i in range(3):
        bow[i] = R[i, 0]
    H, residual = _row(state, R, bow, biased), np.empty(1)
    expected = np.arctan2(bow[1], bow[0]) + H[0, HEADING_BIAS] * state.compass_bias[2]
    residual[0] = _within_half_a_turn(measured - expected)
    return residual, H


@exact_inner
def magnetic(
    state: NavigationState, field: Array, earth: Array, biased: bool
) -> tuple[Array, Array]:
    """Residual (1,) rad of a magnetic field in body axes by its heading, and H (1, n)."""
    R = quat_to_matrix(state.quaternion)
    seen = R @ field
    H, residual = _row(state, R, earth, biased), np.empty(1)
    turned = np.arctan2(earth[1], earth[0]) - np.arctan2(seen[1], seen[0])
    residual[0] = _within_half_a_turn(turned - H[0, HEADING_BIAS] * state.compass_bias[2])
    return residual, H


@exact_kernel
def correct_heading(
    fields: Fields, measured: float, variance: float, biased: bool, gate: float
) -> float:
    """A heading, rad, and its variance, rad^2; `biased`: with the bias that is a state."""
    state = NavigationState(*fields)
    residual, H = heading(state, measured, biased)
    N = np.empty((1, 1))
    N[0, 0] = variance
    return correct(state, H, residual, N, gate)


@exact_kernel
def correct_magnetic(
    fields: Fields, field: Array, earth: Array, variance: float, biased: bool, gate: float
) -> float:
    """A field (3,) in body axes, that of the Earth (3,) north-east-down, variance in rad^2."""
    state = NavigationState(*fields)
    residual, H = magnetic(state, field, earth, biased)
    N = np.empty((1, 1))
    N[0, 0] = variance
    return correct(state, H, residual, N, gate)
