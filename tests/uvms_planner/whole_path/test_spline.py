"""Clamped splines against scipy's."""

import numpy as np
from scipy.interpolate import BSpline

from uvms_planner.whole_path.spline import (
    DEGREE,
    basis_at,
    end_coefficients,
    greville,
    knots_at,
    last_coefficients,
)

KNOTS = knots_at(np.array([0.0, 0.1, 0.4, 1.0, 1.5, 3.0]))
COUNT = len(KNOTS) - DEGREE - 1


def values(coefficients, times, row):
    basis = basis_at(KNOTS, times)
    near = coefficients[basis.first[:, None] + np.arange(DEGREE + 1)]
    return np.einsum("ka,kad->kd", basis.values[:, row], near)


def test_value_and_derivatives_are_those_of_scipy():
    coefficients = np.random.default_rng(1).standard_normal((COUNT, 3))
    times = np.linspace(0.0, 3.0, 301)
    spline = BSpline(KNOTS, coefficients, DEGREE)
    for row in range(3):
        expected = spline.derivative(row)(times) if row else spline(times)
        np.testing.assert_allclose(values(coefficients, times, row), expected, atol=1e-10)


def test_the_spline_begins_and_ends_in_the_given_states():
    begin, end = np.random.default_rng(2).standard_normal((2, 3, 2))
    coefficients = np.zeros((COUNT, 2))
    coefficients[:3] = end_coefficients(KNOTS, *begin)
    coefficients[-3:] = last_coefficients(KNOTS, *end)
    for row in range(3):
        both = values(coefficients, np.array([0.0, 3.0]), row)
        np.testing.assert_allclose(both, [begin[row], end[row]], atol=1e-9)


def test_coefficients_at_the_greville_points_are_the_time_itself():
    times = np.linspace(0.0, 3.0, 50)
    np.testing.assert_allclose(values(greville(KNOTS)[:, None], times, 0)[:, 0], times, atol=1e-12)
