"""The active-set solver against independent solvers, its optimality conditions and warm starts."""

import daqp
import numpy as np
import pytest
import quadprog
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from uvms_control.allocation.box_qp import (
    NOT_POSITIVE_DEFINITE,
    TOO_MANY_STEPS,
    solve_box_qp,
)


def problem(seed, m, rows=6, regularisation=1e-3, spread=3.0):
    """A random bounded least-squares problem: (A, b, H, g, lower, upper)."""
    rng = np.random.default_rng(seed)
    matrix = rng.normal(size=(rows, m)) * 10.0 ** rng.uniform(-1.0, 1.0, size=m)
    target = spread * rng.normal(size=rows) * 10.0 ** rng.uniform(-1.0, 1.5)
    stacked = np.vstack([matrix, np.sqrt(regularisation) * np.eye(m)])
    rhs = np.concatenate([target, np.zeros(m)])
    lower, upper = -rng.uniform(0.0, 2.0, m), rng.uniform(0.0, 2.0, m)
    return stacked, rhs, stacked.T @ stacked, -stacked.T @ rhs, lower, upper


def minimum_by_enumeration(hessian, g, lower, upper):
    """The same minimum by trying every assignment of bounds: slow and simple.

    u is the minimum exactly when the free gradient vanishes, u lies in the box, and the gradient
    pushes held variables outwards (Karush-Kuhn-Tucker). For up to about eight variables.
    """
    best, best_violation = np.clip(np.zeros_like(g), lower, upper), np.inf
    for code in np.ndindex(*(3,) * g.size):
        state = np.array(code) - 1
        u = np.where(state == -1, lower, upper)
        free = state == 0
        held_load = hessian[:, ~free] @ u[~free] + g
        u[free] = np.linalg.solve(hessian[np.ix_(free, free)], -held_load[free])
        multiplier = -state * (hessian @ u + g)
        violation = max(np.max(lower - u), np.max(u - upper), np.max(-multiplier, initial=0.0))
        if violation < best_violation:
            best, best_violation = u, violation
    return best


def solve(hessian, g, lower, upper, u=None, state=None):
    u = np.zeros(g.size) if u is None else u.copy()
    state = np.zeros(g.size, dtype=np.int64) if state is None else state.copy()
    steps = solve_box_qp(hessian, g, lower, upper, u, state, 100 * g.size)
    assert steps > 0
    return u, state, steps


@settings(max_examples=150, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 14))
def test_karush_kuhn_tucker_conditions_hold(seed, m):
    _, _, hessian, g, lower, upper = problem(seed, m)
    u, state, _ = solve(hessian, g, lower, upper)
    gradient = hessian @ u + g
    tolerance = 1e-9 * (np.abs(hessian) @ np.abs(u) + np.abs(g)).max()
    assert np.all(u >= lower)
    assert np.all(u <= upper)
    assert np.all(np.abs(gradient[state == 0]) <= tolerance)
    assert np.all(u[state == -1] == lower[state == -1])
    assert np.all(u[state == 1] == upper[state == 1])
    assert np.all(gradient[state == -1] >= -tolerance)
    assert np.all(gradient[state == 1] <= tolerance)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 12))
def test_agrees_with_scipy_lsq_linear(seed, m):
    stacked, rhs, hessian, g, lower, upper = problem(seed, m)
    u, _, _ = solve(hessian, g, lower, upper)
    reference = lsq_linear(stacked, rhs, (lower, upper + 1e-12), method="bvls", tol=1e-14).x

    def cost(x):
        return np.sum((stacked @ x - rhs) ** 2)

    # By cost: bvls now and then stops short of the optimum, and is then the worse of the two.
    assert cost(u) <= (1.0 + 1e-9) * cost(reference) + 1e-9


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 12))
def test_agrees_with_quadprog_and_daqp(seed, m):
    _, _, hessian, g, lower, upper = problem(seed, m)
    u, _, _ = solve(hessian, g, lower, upper)
    box = np.hstack([np.eye(m), -np.eye(m)])
    dual = quadprog.solve_qp(hessian, -g, box, np.concatenate([lower, -upper]))[0]
    found, _, flag, _ = daqp.solve(
        hessian, g, np.empty((0, m)), upper, lower, np.zeros(m, dtype=np.int32)
    )
    assert flag == 1
    assert np.allclose(u, dual, atol=1e-6)
    assert np.allclose(u, found, atol=1e-5)


@pytest.mark.parametrize("seed", range(12))
def test_agrees_with_the_enumeration_of_all_bound_sets(seed):
    _, _, hessian, g, lower, upper = problem(seed, 5)
    u, _, _ = solve(hessian, g, lower, upper)
    assert np.allclose(u, minimum_by_enumeration(hessian, g, lower, upper), atol=1e-10)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 10))
def test_any_warm_start_leads_to_the_same_minimum(seed, m):
    _, _, hessian, g, lower, upper = problem(seed, m)
    cold, _, _ = solve(hessian, g, lower, upper)
    rng = np.random.default_rng(seed + 1)
    warm, _, _ = solve(hessian, g, lower, upper, 5.0 * rng.normal(size=m), rng.integers(-1, 2, m))
    assert np.allclose(cold, warm, atol=1e-8)


def test_the_solution_as_warm_start_takes_one_step():
    _, _, hessian, g, lower, upper = problem(3, 9)
    u, state, steps = solve(hessian, g, lower, upper)
    again, _, second = solve(hessian, g, lower, upper, u, state)
    assert steps > 1
    assert second == 1
    assert np.allclose(u, again, atol=1e-12)


def test_a_box_of_no_width_is_respected():
    _, _, hessian, g, lower, upper = problem(5, 4)
    lower[2] = upper[2] = 0.25
    u, _, _ = solve(hessian, g, lower, upper)
    assert u[2] == 0.25
    kept = np.array([0, 1, 3])
    smaller = minimum_by_enumeration(
        hessian[np.ix_(kept, kept)], g[kept] + 0.25 * hessian[kept, 2], lower[kept], upper[kept]
    )
    assert np.allclose(u[kept], smaller, atol=1e-10)


def test_failure_is_reported_not_hidden():
    g, bound = np.array([1.0, 1.0]), np.ones(2)
    u, state = np.zeros(2), np.zeros(2, dtype=np.int64)
    indefinite = np.array([[1.0, 2.0], [2.0, 1.0]])
    assert solve_box_qp(indefinite, g, -bound, bound, u, state, 50) == NOT_POSITIVE_DEFINITE
    u[:], state[:] = 0.0, 0
    assert solve_box_qp(np.eye(2), 9.0 * g, -bound, bound, u, state, 1) == TOO_MANY_STEPS
