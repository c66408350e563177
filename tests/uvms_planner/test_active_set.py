import numpy as np
import pytest
import quadprog
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_planner.active_set import solve_program


def random_program(seed, others):
    """(H, g, lower, upper, E, C, d) with x = 0 feasible; some bounds touch it."""
    rng = np.random.default_rng(seed)
    count, equations = 8, 3
    root = rng.normal(size=(count, count))
    hessian = root @ root.T + 1e-3 * np.eye(count)
    lower, upper = -rng.random(count), rng.random(count)
    lower[rng.random(count) < 0.2] = 0.0
    equal, rows = rng.normal(size=(equations, count)), rng.normal(size=(others, count))
    limits = np.where(rng.random(others) < 0.3, 0.0, rng.random(others))
    return hessian, 5.0 * rng.normal(size=count), lower, upper, equal, rows, limits


@given(seed=st.integers(0, 2**32 - 1), others=st.integers(0, 5))
@settings(max_examples=150, deadline=None)
def test_it_is_the_minimizer_that_goldfarb_and_idnani_find(seed, others):
    hessian, gradient, lower, upper, equal, rows, limits = random_program(seed, others)
    x, weights = np.zeros(8), np.zeros(others)
    solved = solve_program(hessian, gradient, lower, upper, equal, rows, limits, x, weights)
    assert solved > 0
    eye = np.eye(8)
    constraints = np.vstack([equal, eye, -eye, -rows]).T
    bounds = np.concatenate([np.zeros(3), lower, -upper, -limits])
    expected, value, *_ = quadprog.solve_qp(hessian, -gradient, constraints, bounds, meq=3)
    assert x == pytest.approx(expected, abs=1e-6)
    assert 0.5 * x @ hessian @ x + gradient @ x == pytest.approx(value, abs=1e-8, rel=1e-8)
    assert np.all(weights >= -1e-9)
    assert np.all(rows @ x <= limits + 1e-8)


def test_the_multipliers_of_rows_are_prices():
    """d cost / d limit = - multiplier, by finite differences."""
    hessian, gradient = np.diag([1.0, 2.0]), np.array([-3.0, -4.0])
    wide, no_rows = np.full(2, 10.0), np.zeros((0, 2))

    def solved(limit):
        x, weights = np.zeros(2), np.zeros(1)
        rows = np.array([[1.0, 1.0]])
        solve_program(hessian, gradient, -wide, wide, no_rows, rows, np.array([limit]), x, weights)
        return 0.5 * x @ hessian @ x + gradient @ x, weights[0]

    slope = (solved(1.0 + 1e-5)[0] - solved(1.0 - 1e-5)[0]) / 2e-5
    assert solved(1.0)[1] == pytest.approx(-slope, rel=1e-6)
    assert solved(1.0)[1] == pytest.approx(8.0 / 3.0)
    assert solved(9.0)[1] == 0.0


def test_a_variable_whose_bounds_meet_stays():
    x, none = np.zeros(2), np.zeros((0, 2))
    lower, upper = np.array([0.0, -1.0]), np.array([0.0, 1.0])
    solve_program(
        np.eye(2), np.array([5.0, 0.5]), lower, upper, none, none, np.zeros(0), x, np.zeros(0)
    )
    assert x == pytest.approx([0.0, -0.5])
