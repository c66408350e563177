"""The Lyapunov function of a run against the one of s_surface, and its rate against the motion."""

import numpy as np
import pytest

from uvms_control.errors import ControlSetupError
from uvms_control.s_surface import SSurface, lyapunov
from uvms_control.stability import StabilityMonitor

STIFFNESS = np.array([2.0, 3.0, 4.0, 1.0, 2.5, 5.0])
DAMPING = np.array([2.0, 2.5, 3.0, 1.5, 2.0, 4.0])


@pytest.fixture
def rng():
    return np.random.default_rng(11)


def mass_of(rng):
    root = rng.normal(size=(6, 6))
    return root @ root.T + np.diag([200.0, 300.0, 300.0, 5.0, 100.0, 100.0])


def test_value_is_the_lyapunov_function_of_equation_27(rng):
    error, rate = rng.normal(size=(2, 6))
    monitor = StabilityMonitor(STIFFNESS, DAMPING)
    found = monitor.at(7, error, rate, mass_of(rng), rng.normal(size=6), rng.normal(size=6))
    assert found.stamp == 7
    assert monitor.epsilon == 0.5 * DAMPING.min()
    assert found.lyapunov == pytest.approx(float(lyapunov(error, rate, STIFFNESS, DAMPING)))


def test_rate_is_that_of_the_motion_under_the_wrench(rng):
    """V of the errors a moment later and before, by M e_ddot = b - tau."""
    error, rate, needed, wrench = rng.normal(size=(4, 6))
    mass = mass_of(rng)
    found = StabilityMonitor(STIFFNESS, DAMPING).at(0, error, rate, mass, needed, wrench)
    acceleration = np.linalg.solve(mass, needed - wrench)
    step = 1e-5
    ahead, behind = (
        float(lyapunov(error + s * rate, rate + s * acceleration, STIFFNESS, DAMPING))
        for s in (step, -step)
    )
    assert found.lyapunov_rate == pytest.approx((ahead - behind) / (2.0 * step), rel=1e-6)


def test_rate_of_a_linear_loop_is_that_of_equation_29(rng):
    """tau = b + M (P e + D e_dot): V_dot = -eps e' P e - e_dot' (D - eps) e_dot."""
    error, rate, needed = rng.normal(size=(3, 6))
    mass = mass_of(rng)
    wrench = needed + mass @ (STIFFNESS * error + DAMPING * rate)
    monitor = StabilityMonitor(STIFFNESS, DAMPING)
    found = monitor.at(0, error, rate, mass, needed, wrench)
    eps = monitor.epsilon
    expected = -eps * error @ (STIFFNESS * error) - rate @ ((DAMPING - eps) * rate)
    assert found.lyapunov_rate == pytest.approx(expected)


def test_the_s_surface_makes_v_fall_wherever_it_is(rng):
    """Beyond the linear part the slope of S falls, and V still does near its axis of motion."""
    law = SSurface(np.full(6, 2.0), np.full(6, 2.0), *(np.full(6, v) for v in (0.15, 0.1, 0.15)))
    monitor = StabilityMonitor(law.stiffness, law.damping)
    mass = mass_of(rng)
    for _ in range(200):
        error, rate, needed = rng.normal(size=(3, 6)) * [[0.01], [0.01], [10.0]]
        wrench = needed + mass @ law.acceleration(error, rate)
        assert monitor.at(0, error, rate, mass, needed, wrench).lyapunov_rate < 0.0


def test_power_of_the_wrench_and_the_greatest_of_the_load(rng):
    rate, needed, wrench = rng.normal(size=(3, 6))
    mass = mass_of(rng)
    found = StabilityMonitor(STIFFNESS, DAMPING).at(0, np.zeros(6), rate, mass, needed, wrench)
    assert found.supply == pytest.approx(rate @ wrench)
    sizes = rate @ mass @ rate, needed @ np.linalg.solve(mass, needed)
    assert found.demand == pytest.approx(np.sqrt(sizes[0] * sizes[1]))
    assert found.demand >= abs(rate @ needed)


def test_no_load_of_the_same_size_takes_more_than_the_demand(rng):
    """The demand is reached by the load along M e_dot, and by no other of the same norm."""
    rate, mass = rng.normal(size=6), mass_of(rng)
    monitor = StabilityMonitor(STIFFNESS, DAMPING)
    worst = monitor.at(0, np.zeros(6), rate, mass, mass @ rate, np.zeros(6))
    assert worst.demand == pytest.approx(rate @ mass @ rate)


def test_the_condition_does_not_depend_on_the_unit_of_length(rng):
    """Centimetres instead of metres: the power of forces stays as it is, in other numbers."""
    rate, needed, wrench = rng.normal(size=(3, 6))
    mass = mass_of(rng)
    scale = np.diag([100.0] * 3 + [1.0] * 3)
    inverse = np.linalg.inv(scale)
    monitor = StabilityMonitor(STIFFNESS, DAMPING)
    one = monitor.at(0, np.zeros(6), rate, mass, needed, wrench)
    other = monitor.at(
        0, np.zeros(6), scale @ rate, inverse @ mass @ inverse, inverse @ needed, inverse @ wrench
    )
    assert (other.supply, other.demand) == pytest.approx((one.supply, one.demand))


def test_an_axis_that_is_left_to_the_hull_is_in_none_of_the_figures(rng):
    stiffness, damping = STIFFNESS.copy(), DAMPING.copy()
    stiffness[4] = damping[4] = 0.0
    monitor = StabilityMonitor(stiffness, damping)
    error, rate, needed = rng.normal(size=(3, 6))
    wrench = needed.copy()
    mass = mass_of(rng)
    one = monitor.at(0, error, rate, mass, needed, wrench)
    error[4], rate[4] = 100.0, -50.0
    assert monitor.at(0, error, rate, mass, needed, wrench) == one
    nothing = StabilityMonitor(np.zeros(6), np.zeros(6)).at(0, error, rate, mass, needed, wrench)
    assert (nothing.lyapunov, nothing.demand, nothing.supply) == (0.0, 0.0, 0.0)


def test_half_a_feedback_is_refused():
    with pytest.raises(ControlSetupError, match="both above 0 or both 0 on every axis"):
        StabilityMonitor(STIFFNESS, np.zeros(6))
