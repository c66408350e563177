"""Resistance of the hull to its motion through the water: damping and fins, in body axes.

A hull whose damping is diagonal and that has no fins costs two looks at flags more than that.
"""

import numpy as np

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import (
    DAMPING,
    FIN_CHORD,
    FIN_COUNT,
    FIN_DRAG,
    FIN_INDUCED,
    FIN_NORMAL,
    FIN_NUMBERS,
    FIN_PLATE,
    FIN_POSITION,
    FIN_PRESSURE,
    FIN_SLOPE,
    FIN_STALL,
    FINS,
    HULL,
    MATRICES,
    QUADRATIC,
)
from uvms_dynamics.kernels.numba_internals.primitives import fabs, maximum, read, sqrt
from uvms_dynamics.kernels.spatial import add_vectors, angular, cross, linear, load6, pair, plus

_STILL = 1e-150  # m/s; below it a fin has no force, and its angle of attack is any
_ROW, _MATRIX = np.int64(6), np.int64(36)


@inner
def hull_damping(model, nu):
    """D(nu) nu of the hull with its fins, as a resistance: what it takes to overcome it."""
    d, e = load6(model, HULL, DAMPING), load6(model, HULL, QUADRATIC)
    force = (
        (d[0] + e[0] * fabs(nu[0])) * nu[0],
        (d[1] + e[1] * fabs(nu[1])) * nu[1],
        (d[2] + e[2] * fabs(nu[2])) * nu[2],
        (d[3] + e[3] * fabs(nu[3])) * nu[3],
        (d[4] + e[4] * fabs(nu[4])) * nu[4],
        (d[5] + e[5] * fabs(nu[5])) * nu[5],
    )
    matrices = np.int64(model[HULL, MATRICES])
    if matrices > 0:
        force = plus(force, _matrix_damping(model, matrices, nu))
    first = np.int64(model[HULL, FINS])
    for fin in range(np.int64(model[HULL, FIN_COUNT])):
        force = plus(force, _fin_resistance(model, first + FIN_NUMBERS * fin, nu))
    return force


@inner
def _matrix_damping(model, first, nu):
    """(L + Q diag(|nu|) + |u| P) nu with the three matrices one after the other."""
    u = fabs(nu[0])
    square = (
        fabs(nu[0]) * nu[0],
        fabs(nu[1]) * nu[1],
        fabs(nu[2]) * nu[2],
        fabs(nu[3]) * nu[3],
        fabs(nu[4]) * nu[4],
        fabs(nu[5]) * nu[5],
    )
    product = u * nu[0], u * nu[1], u * nu[2], u * nu[3], u * nu[4], u * nu[5]
    force = _product(model, first, nu)
    force = plus(force, _product(model, first + _MATRIX, square))
    return plus(force, _product(model, first + 2 * _MATRIX, product))


@inner
def _product(model, first, a):
    """A 6x6 matrix times six numbers."""
    return (
        _row_product(model, first, a),
        _row_product(model, first + _ROW, a),
        _row_product(model, first + 2 * _ROW, a),
        _row_product(model, first + 3 * _ROW, a),
        _row_product(model, first + 4 * _ROW, a),
        _row_product(model, first + 5 * _ROW, a),
    )


@inner
def _row_product(model, k, a):
    low = read(model, k) * a[0] + read(model, k + 1) * a[1] + read(model, k + 2) * a[2]
    high = read(model, k + 3) * a[3] + read(model, k + 4) * a[4] + read(model, k + 5) * a[5]
    return low + high


@inner
def _fin_resistance(model, first, nu):
    """Lift, drag and stall of one fin, with the signs turned; `uvms_core.vehicle.fins` has them.

    Per 1/2 rho S U^2: lift C_L across the flow, drag C_D against it, and f C_90 s along the
    normal of what has separated.
    """
    place = _vector(model, first + FIN_POSITION)
    chord, normal = _vector(model, first + FIN_CHORD), _vector(model, first + FIN_NORMAL)
    v = add_vectors(linear(nu), cross(angular(nu), place))
    along = chord[0] * v[0] + chord[1] * v[1] + chord[2] * v[2]
    across = normal[0] * v[0] + normal[1] * v[1] + normal[2] * v[2]
    speed = sqrt(along * along + across * across)
    inverse = 1.0 / maximum(speed, _STILL)
    s, c = across * inverse, along * inverse
    x = s * s * read(model, first + FIN_STALL)
    x = x * x
    x = x * x
    separated = x / (1.0 + x)
    lift = (1.0 - separated) * read(model, first + FIN_SLOPE) * s * c
    drag = read(model, first + FIN_DRAG) + lift * lift * read(model, first + FIN_INDUCED)
    pressure = read(model, first + FIN_PRESSURE) * speed * speed
    a = pressure * (drag * c - lift * s)
    b = pressure * (lift * c + drag * s + separated * read(model, first + FIN_PLATE) * s)
    force = (
        a * chord[0] + b * normal[0],
        a * chord[1] + b * normal[1],
        a * chord[2] + b * normal[2],
    )
    return pair(force, cross(place, force))


@inner
def _vector(model, first):
    return read(model, first), read(model, first + 1), read(model, first + 2)
