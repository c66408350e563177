"""Clamped B-splines of degree 4: their basis at given times, and splines through given states.

De Boor, A Practical Guide to Splines (2001), ch. IX-X. Degree 4 makes the acceleration a spline of
degree 2, continuous with its rate, and as low a degree as possible keeps the bounds by the convex
hull of the coefficients tight.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import inner, kernel

DEGREE = 4
FIXED = 3  # coefficients that value, rate and acceleration at one end decide


class Basis(NamedTuple):
    """The functions that are not zero at each of k times."""

    first: Array  # (k,) number of the first of them
    values: Array  # (k, 3, DEGREE + 1) of these functions, their first and second derivatives


def knots_at(breaks: Array) -> Array:
    """Clamped knots of splines whose pieces meet at `breaks` (b,) s, increasing."""
    return np.concatenate([[breaks[0]] * DEGREE, breaks, [breaks[-1]] * DEGREE])


def basis_at(knots: Array, times: Array) -> Basis:
    """The basis at `times` (k,) s, which must lie within the knots."""
    last = len(knots) - DEGREE - 2
    times = np.asarray(times, dtype=np.float64)
    spans = np.clip(np.searchsorted(knots, times, side="right") - 1, DEGREE, last)
    return Basis((spans - DEGREE).astype(np.int64), _functions(knots, times, spans))


def spline_values(basis: Basis, coefficients: Array) -> Array:
    """Splines of `coefficients` (K, d), and two derivatives, at the times of a basis: (k, 3, d)."""
    near = coefficients[basis.first[:, None] + np.arange(DEGREE + 1)]
    return np.einsum("kra,kad->krd", basis.values, near)


@kernel
def _functions(knots, times, spans):
    """Functions and two derivatives (k, 3, DEGREE + 1) of those that are not zero."""
    out = np.zeros((times.shape[0], 3, DEGREE + 1))
    low, work = np.zeros((DEGREE + 1, DEGREE + 1)), np.zeros(DEGREE + 1)
    for i in range(times.shape[0]):
        low[0, 0] = 1.0
        for degree in range(1, DEGREE + 1):
            _raise(knots, times[i], spans[i], low[degree - 1], degree, low[degree])
        out[i, 0] = low[DEGREE]
        _differentiate(knots, spans[i], low[DEGREE - 1], DEGREE, out[i, 1])
        _differentiate(knots, spans[i], low[DEGREE - 2], DEGREE - 1, work)
        _differentiate(knots, spans[i], work, DEGREE, out[i, 2])
    return out


@inner
def _raise(knots, time, span, lower, degree, out):
    """Fill `out` with the functions of `degree` from those of one degree less."""
    out[:] = 0.0
    for j in range(degree):
        left, right = knots[span + j + 1 - degree], knots[span + j + 1]
        share = (time - left) / (right - left)
        out[j] += (1 - share) * lower[j]
        out[j + 1] += share * lower[j]


@inner
def _differentiate(knots, span, lower, degree, out):
    """Fill `out` with derivatives of the functions of `degree` from those of one degree less."""
    out[:] = 0.0
    for j in range(degree):
        left, right = knots[span + j + 1 - degree], knots[span + j + 1]
        slope = degree * lower[j] / (right - left)
        out[j] -= slope
        out[j + 1] += slope


def rate_factors(knots: Array, degree: int) -> Array:
    """Factors f such that the derivative's coefficients are f_i (c_{i+1} - c_i).

    `knots` are those of a spline of `degree`, that of the derivative has them without the ends.
    """
    span = knots[degree + 1 : -1] - knots[1 : -degree - 1]
    return degree / span


def end_coefficients(knots: Array, value: Array, rate: Array, acceleration: Array) -> Array:
    """The first three coefficients (3, d) of a spline that begins in a given state."""
    first = rate_factors(knots, DEGREE)
    second = rate_factors(knots[1:-1], DEGREE - 1)
    rates = np.stack([rate, rate + acceleration / second[0]])
    return np.stack(
        [value, value + rates[0] / first[0], value + rates[0] / first[0] + rates[1] / first[1]]
    )


def last_coefficients(knots: Array, value: Array, rate: Array, acceleration: Array) -> Array:
    """The last three coefficients (3, d) of a spline that ends in a given state."""
    mirrored = end_coefficients(knots[-1] - knots[::-1], value, -rate, acceleration)
    return mirrored[::-1]


def greville(knots: Array) -> Array:
    """Times (K,) at which coefficients act most: the coefficients of the spline s(t) = t."""
    count = len(knots) - DEGREE - 1
    return np.array([knots[i + 1 : i + 1 + DEGREE].mean() for i in range(count)])
