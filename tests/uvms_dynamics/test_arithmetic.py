"""The kernels' own functions of numbers, against the C library and exact arithmetic."""

import math

import numpy as np
import pytest
from numba import njit

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model
from uvms_dynamics.kernels.arithmetic import bounded, hyperbolic_tangent, sine_cosine
from uvms_dynamics.kernels.drag import coefficient
from uvms_dynamics.kernels.drag_table import FIRST_OCTAVE, LAST_OCTAVE, resample
from uvms_dynamics.kernels.jit import OPTIONS
from uvms_dynamics.kernels.layout import AXIAL, CROSS_FLOW, HULL
from uvms_dynamics.kernels.numba_internals.lanes import LANES, lane_vector

plain = njit(**{key: value for key, value in OPTIONS.items() if key != "forceinline"})
ULP = np.finfo(float).eps


@plain
def sine_cosine_of(x, out):
    for i in range(x.shape[0]):
        out[i, 0], out[i, 1] = sine_cosine(x[i])


@plain
def tangent_of(x, out):
    for i in range(x.shape[0]):
        out[i] = hyperbolic_tangent(x[i])


@plain
def bounded_of(x, bound, out):
    for i in range(x.shape[0]):
        out[i] = bounded(x[i], bound)


@plain
def coefficient_of(model, first, reynolds, out):
    for i in range(reynolds.shape[0]):
        out[i] = coefficient(model, first, reynolds[i])


@plain
def by_lanes(model, first, x, out):
    """Columns: sine, cosine, tanh, bounded by 1, drag coefficient; x and out are of lanes."""
    values, results = lane_vector(x), lane_vector(out)
    s, c = sine_cosine(values[0])
    results[0], results[1], results[2] = s, c, hyperbolic_tangent(values[0])
    results[3] = bounded(values[0], 1.0)
    results[4] = coefficient(model, first, values[0])


ANGLES = np.concatenate(
    [
        np.linspace(-20.0, 20.0, 20001),
        np.arange(-40, 41) * (np.pi / 2.0),
        np.random.default_rng(0).uniform(-1e6, 1e6, 5000),
        [0.0, 1e-300, -1e-9, 1e-5],
    ]
)


def test_sine_and_cosine_are_the_c_librarys_to_two_bits():
    found = np.empty((len(ANGLES), 2))
    sine_cosine_of(ANGLES, found)
    expected = np.column_stack([np.sin(ANGLES), np.cos(ANGLES)])
    assert np.abs(found - expected).max() <= 2.0 * ULP
    small = np.abs(ANGLES) < 1.0
    np.testing.assert_allclose(found[small], expected[small], rtol=4.0 * ULP, atol=0.0)


def test_hyperbolic_tangent_is_the_c_librarys_to_a_few_bits():
    x = np.concatenate([np.linspace(-30.0, 30.0, 20001), 10.0 ** np.linspace(-300.0, 2.0, 3000)])
    found = np.empty_like(x)
    tangent_of(x, found)
    np.testing.assert_allclose(found, np.tanh(x), rtol=8.0 * ULP, atol=0.0)
    np.testing.assert_array_equal(np.signbit(found), np.signbit(x))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_what_is_not_finite_becomes_nan(value):
    found = np.empty((1, 2))
    sine_cosine_of(np.array([value]), found)
    assert np.isnan(found).all()


def test_bounded():
    found = np.empty(5)
    bounded_of(np.array([-3.0, -2.0, 0.5, 2.0, math.inf]), 2.0, found)
    np.testing.assert_array_equal(found, [-2.0, -2.0, 0.5, 2.0, 2.0])


VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
TABLES = {CROSS_FLOW: VEHICLE.arm.drag_coefficient, AXIAL: VEHICLE.arm.friction_coefficient}


@pytest.mark.parametrize("column", TABLES)
def test_drag_coefficients_lie_on_the_lines_between_the_tables_points(column):
    nodes, values = resample(TABLES[column])
    reynolds = np.concatenate([nodes, nodes * 1.01, 10.0 ** np.linspace(-6.0, 12.0, 5000), [0.0]])
    found = np.empty_like(reynolds)
    coefficient_of(MODEL, np.int64(MODEL[HULL, column]), reynolds, found)
    np.testing.assert_allclose(found, np.interp(reynolds, nodes, values), rtol=1e-13)
    below, above = reynolds < 2.0**FIRST_OCTAVE, reynolds > 2.0**LAST_OCTAVE
    assert below.any()
    assert above.any()
    np.testing.assert_array_equal(found[below], values[0])


def test_no_reynolds_number_reads_beyond_the_table():
    found = np.empty(3)
    first = np.int64(MODEL[HULL, CROSS_FLOW])
    coefficient_of(MODEL, first, np.array([math.nan, math.inf, -1.0]), found)
    assert np.isfinite(found).all()


def test_lanes_are_the_same_numbers_eight_at_a_time():
    x = np.array([0.0, -0.3, 1.5, -7.0, 30.0, 100.0, 2e5, 3e-3])
    found, first = np.empty((5, LANES)), np.int64(MODEL[HULL, CROSS_FLOW])
    by_lanes(MODEL, first, x[None, :].copy(), found)
    pairs, tangent, limited, drag = np.empty((LANES, 2)), *np.empty((3, LANES))
    sine_cosine_of(x, pairs)
    tangent_of(x, tangent)
    bounded_of(x, 1.0, limited)
    coefficient_of(MODEL, first, x, drag)
    expected = np.vstack([pairs.T, tangent, limited, drag])
    np.testing.assert_allclose(found, expected, rtol=4.0 * ULP, atol=4.0 * ULP)
