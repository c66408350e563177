"""The S-surface law: shape, slope, series, and the fall of its Lyapunov function."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from uvms_control.errors import ControlSetupError
from uvms_control.s_surface import SSurface, lyapunov, sigmoid, sigmoid_series

LAW = SSurface(
    k_error=np.array([2.0, 3.0, 1.5]),
    k_rate=np.array([2.0, 1.0, 2.5]),
    error_scale=np.array([0.1, 0.2, 0.3]),
    rate_scale=np.array([0.1, 0.1, 0.2]),
    amplitude=np.array([0.2, 0.5, 1.0]),
)
threes = st.lists(st.floats(-1e3, 1e3), min_size=3, max_size=3).map(np.array)


@settings(deadline=None)
@given(s=st.floats(-30.0, 30.0))
def test_sigmoid_is_the_printed_fraction(s):
    assert sigmoid(s) == pytest.approx(2.0 / (1.0 + np.exp(-s)) - 1.0, abs=1e-14)


@settings(deadline=None)
@given(error=threes, rate=threes)
def test_law_is_odd_and_bounded(error, rate):
    assert np.array_equal(LAW.control(-error, -rate), -LAW.control(error, rate))
    assert np.all(np.abs(LAW.acceleration(error, rate)) <= LAW.amplitude)


@settings(deadline=None)
@given(error=threes, more=st.floats(1e-6, 1.0), rate=threes)
def test_law_never_falls_with_the_error(error, more, rate):
    assert np.all(LAW.control(error + more, rate) >= LAW.control(error, rate))
    assert np.all(LAW.control(rate, error + more) >= LAW.control(rate, error))


def test_slopes_at_zero_are_stiffness_and_damping():
    h, zero = 1e-6, np.zeros(3)
    by_error = (LAW.acceleration(zero + h, zero) - LAW.acceleration(zero - h, zero)) / (2 * h)
    by_rate = (LAW.acceleration(zero, zero + h) - LAW.acceleration(zero, zero - h)) / (2 * h)
    assert np.allclose(by_error, LAW.stiffness, rtol=1e-8)
    assert np.allclose(by_rate, LAW.damping, rtol=1e-8)


def test_series_begins_as_the_corrected_equation_23():
    s = np.linspace(-1.0, 1.0, 11)
    assert np.allclose(sigmoid_series(s, 3), s / 2 - s**3 / 24 + s**5 / 240, rtol=1e-13)


def test_series_converges_to_the_sigmoid():
    s = np.linspace(-2.0, 2.0, 41)
    errors = [np.max(np.abs(sigmoid_series(s, n) - sigmoid(s))) for n in (2, 6, 20)]
    assert errors[0] > 20.0 * errors[1] > 20.0 * errors[2]
    assert errors[2] < 1e-7


def test_lyapunov_function_falls_along_the_linear_loop():
    rng = np.random.default_rng(4)
    p, d = LAW.stiffness, LAW.damping
    loop = np.block([[np.zeros((3, 3)), np.eye(3)], [-np.diag(p), -np.diag(d)]])
    step = expm(0.02 * loop)
    for start in rng.normal(size=(20, 6)):
        run = [start]
        for _ in range(300):
            run.append(step @ run[-1])
        values = lyapunov(np.array(run)[:, :3], np.array(run)[:, 3:], p, d)
        assert np.all(values > 0.0)
        assert np.all(np.diff(values) < 0.0)
        assert values[-1] < 0.05 * values[0]


def test_lyapunov_derivative_is_the_one_of_equation_29():
    rng = np.random.default_rng(5)
    p, d, h = LAW.stiffness, LAW.damping, 1e-6
    eps = 0.4 * d.min()
    for e, v in rng.normal(size=(20, 2, 3)):
        a = -p * e - d * v
        ahead = lyapunov(e + h * v, v + h * a, p, d, eps)
        behind = lyapunov(e - h * v, v - h * a, p, d, eps)
        expected = -eps * np.sum(p * e**2) - np.sum((d - eps) * v**2)
        assert (ahead - behind) / (2 * h) == pytest.approx(expected, rel=1e-6, abs=1e-8)


def test_the_mass_term_of_the_print_can_grow_on_the_linear_loop():
    """Why 1/2 e_dot^T M e_dot is left out: just after rest it outgrows the rest of V."""
    p, d, mass = 1.0, 2.0, 50.0
    e, v, dt = 1.0, 0.0, 1e-3

    def printed(e, v):
        one = np.ones(1)
        return float(lyapunov(one * e, one * v, p * one, d * one)) + 0.5 * mass * v**2

    before = printed(e, v)
    for _ in range(300):
        e, v = e + dt * v, v + dt * (-p * e - d * v)
    assert printed(e, v) > before


def test_delta_u_adds_to_the_law_in_units_of_the_amplitude():
    delta = np.array([0.5, -0.5, 0.1])
    gained = LAW.acceleration(np.ones(3), np.zeros(3), delta) - LAW.acceleration(
        np.ones(3), np.zeros(3)
    )
    assert np.allclose(gained, LAW.amplitude * delta)


def test_wrong_gains_are_named():
    with pytest.raises(ControlSetupError) as error:
        SSurface(np.ones(2), np.array([1.0, -1.0]), np.ones(2), np.ones(2), np.ones(2))
    assert str(error.value) == ("S-surface k_rate: [ 1. -1.], expected 2 positive finite numbers")
    with pytest.raises(ControlSetupError) as error:
        lyapunov(np.ones(2), np.ones(2), np.ones(2), np.ones(2), 1.5)
    assert str(error.value) == "lyapunov epsilon: 1.5, expected between 0 and 1"
