"""Clamped B-splines of degree 4: their basis at given times, and splines through given states.

De Boor, A Practical Guide to Splines (2001), ch. IX-X. Degree 4 makes the acceleration a spline of
degree 2, continuous with its rate, and as low a degree as possible keeps the bounds by the convex
hull of the coefficients tight.
"""

from typing import Any, NamedTuple

import numpy as np

from uvms_core.signals import Array

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
    spans = np.clip(np.searchsorted(knots, times, side="right") - 1, DEGREE, last)
    low = {DEGREE - 2: _cox_de_boor(knots, times, spans, DEGREE - 2)}
    for degree in (DEGREE - 1, DEGREE):
        low[degree] = _raised(knots, times, spans, low[degree - 1], degree)
    rate = _differentiated(knots, spans, low[DEGREE - 1], DEGREE)
    bend = _differentiated(knots, spans, low[DEGREE - 2], DEGREE - 1)
    bend = _differentiated(knots, spans, bend, DEGREE)
    values = np.stack([low[DEGREE], rate, bend], axis=1)
    return Basis((spans - DEGREE).astype(np.int64), np.ascontiguousarray(values))


def _cox_de_boor(knots: Array, times: Array, spans: Any, degree: int) -> Array:
    """The degree + 1 functions of a lower degree that are not zero, (k, degree + 1)."""
    values = np.ones((len(times), 1))
    for p in range(1, degree + 1):
        values = _raised(knots, times, spans, values, p)
    return values


def _raised(knots: Array, times: Array, spans: Any, lower: Array, degree: int) -> Array:
    """Functions of `degree` from those of one degree less."""
    out = np.zeros((len(times), degree + 1))
    for j in range(degree):
        left, right = knots[spans + j + 1 - degree], knots[spans + j + 1]
        share = (times - left) / (right - left)
        out[:, j] += (1 - share) * lower[:, j]
        out[:, j + 1] += share * lower[:, j]
    return out


def _differentiated(knots: Array, spans: Any, lower: Array, degree: int) -> Array:
    """Derivatives of the functions of `degree` from those of one degree less (or theirs)."""
    out = np.zeros((len(spans), degree + 1))
    for j in range(degree):
        left, right = knots[spans + j + 1 - degree], knots[spans + j + 1]
        slope = degree * lower[:, j] / (right - left)
        out[:, j] -= slope
        out[:, j + 1] += slope
    return out


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
