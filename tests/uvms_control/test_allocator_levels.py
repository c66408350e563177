"""Allocation by priorities: the lexicographic optimum, against sequences of exact programs."""

import contextlib

import daqp
import numpy as np
import pytest
import quadprog
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from uvms_control.allocation import (
    LexicographicLeastSquares,
    ThrustAllocator,
    WeightedAllocator,
    solve_levels,
)
from uvms_control.allocation.levels import TOO_MANY_STEPS, workspace
from uvms_control.config import AllocatorConfig
from uvms_core.plugin import create
from uvms_core.signals import Wrench
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import configuration_matrix

VEHICLE = load_vehicle()
REFERENCE = ThrustAllocator(VEHICLE, AllocatorConfig())
MATRIX, BOX = REFERENCE.matrix, np.vstack([REFERENCE.lower, REFERENCE.upper])
GROSS = np.abs(MATRIX) @ REFERENCE.limits
LEVELS = [[3, 4], [2], [5], [0, 1]]
SLACKS = (1e-11, 1e-10, 1e-9)
"""Of the levels above in the programs of quadprog that rounding makes infeasible: the least that
does. All are below a hundredth of what the comparisons allow a level."""


def solver(matrix, box, levels=LEVELS):
    limits = np.abs(box).max(axis=0)
    weights = np.array(AllocatorConfig().weights)
    return LexicographicLeastSquares(matrix, box, weights, levels, np.abs(matrix) @ limits)


def by_quadprog(hessian, linear, rows, values, low, high):
    eye = np.eye(len(linear))
    try:
        sides = np.concatenate([values, low, -high])
        return quadprog.solve_qp(hessian, linear, np.vstack([rows, eye, -eye]).T, sides, len(rows))[
            0
        ]
    except ValueError:  # inconsistent by rounding
        both = np.vstack([rows, -rows, eye, -eye]).T
    for slack in SLACKS:
        sides = np.concatenate([values - slack, -values - slack, low, -high])
        with contextlib.suppress(ValueError):
            return quadprog.solve_qp(hessian, linear, both, sides)[0]
    raise AssertionError(f"quadprog finds no solution even with a slack of {SLACKS[-1]}")


def by_daqp(hessian, linear, rows, values, low, high):
    sense = np.array([0] * len(low) + [5] * len(values), dtype=np.int32)
    upper, lower = np.append(high, values), np.append(low, values)
    rows = np.ascontiguousarray(rows)
    found, _, flag, _ = daqp.solve(
        hessian, -linear, rows, upper, lower, sense, primal_tol=1e-9, dual_tol=1e-12
    )
    return found if flag > 0 else by_quadprog(hessian, linear, rows, values, low, high)


def in_sequence(own, tau, low, high, program):
    """Level after level with what those above achieved as equalities, in shares of the limits.

    A level alone is not strictly convex: a proximal term is moved along until it adds nothing.
    """
    target, m = (own._scale * tau)[own.axes], len(low)
    rows, values, u, first = np.zeros((0, m)), np.zeros(0), np.zeros(m), 0
    for end in own._ends:
        a, b = own._rows[first:end], target[first:end]
        for _ in range(40):
            last, u = (
                u,
                program(a.T @ a + 1e-5 * np.eye(m), a.T @ b + 1e-5 * u, rows, values, low, high),
            )
            if np.abs(u - last).max() < 1e-12:
                break
        rows, values, first = np.vstack([rows, a]), np.append(values, a @ u), end
    return own.limits * program(np.eye(m), np.zeros(m), rows, values, low, high)


def layout(rng, m):
    directions = rng.normal(size=(m, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    matrix = configuration_matrix(rng.uniform(-1.0, 1.0, (m, 3)), directions)
    astern = -rng.uniform(0.0, 60.0, m) * (rng.random(m) > 0.2)
    return matrix, np.vstack([astern, rng.uniform(10.0, 100.0, m)])


@pytest.mark.parametrize("program", [by_quadprog, by_daqp])
def test_the_reference_vehicle_gets_the_optimum_of_a_sequence_of_exact_programs(program):
    own, rng = solver(MATRIX, BOX), np.random.default_rng(1)
    for tau in rng.uniform(-1.0, 1.0, (400, 6)) * GROSS:
        expected = in_sequence(own, tau, *BOX / own.limits, program)
        thrust = own.solve(tau, *BOX)
        assert np.abs(MATRIX @ (thrust - expected)).max() < 1e-6
        assert np.abs(thrust - expected).max() < 1e-4


@settings(max_examples=80, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 10))
def test_any_layout_gets_the_optimum_of_a_sequence_of_exact_programs(seed, m):
    rng = np.random.default_rng(seed)
    matrix, box = layout(rng, m)
    levels = [list(each) for each in np.split(rng.permutation(6), sorted(rng.integers(1, 6, 2)))]
    own = solver(matrix, box, [each for each in levels if each])
    tau = 0.7 * rng.uniform(-1.0, 1.0, 6) * (np.abs(matrix) @ own.limits)
    thrust = own.solve(tau, *box)
    assert (thrust >= box[0]).all()
    assert (thrust <= box[1]).all()
    expected = in_sequence(own, tau, *box / own.limits, by_quadprog)
    errors = own._scale[:, None] * np.array([matrix @ each - tau for each in (thrust, expected)]).T
    first = 0
    for end in own._ends:  # by level, since what the reference gives away above helps it below
        mine, other = (np.linalg.norm(errors[own.axes[first:end], k]) for k in (0, 1))
        assert mine <= other + 1e-7
        if mine < other - 1e-7:
            return
        first = end
    assert np.linalg.norm(thrust / own.limits) <= np.linalg.norm(expected / own.limits) + 1e-5


@settings(max_examples=200, deadline=None)
@given(halves=st.lists(st.integers(-6, 6), min_size=6, max_size=6))
def test_symmetric_wrenches_end_and_hold_their_limits(halves):
    """Multiples of a quarter of the authority, where many bounds are met at once."""
    tau = GROSS * np.array(halves) / 4.0
    thrust = solver(MATRIX, BOX).solve(tau, *BOX)
    expected = in_sequence(solver(MATRIX, BOX), tau, *BOX / REFERENCE.limits, by_quadprog)
    assert np.abs(MATRIX @ (thrust - expected)).max() < 1e-6


def test_a_level_keeps_all_that_it_can_have():
    """As weights, Y 300 N with N 30 N m keeps 11.9 N m, though 30 are within reach."""
    tau = np.array([0.0, 300.0, 0.0, 0.0, 0.0, 30.0])
    by_levels = REFERENCE.step(Wrench(0, tau))[1]
    assert by_levels.achieved[5] == pytest.approx(30.0, abs=1e-9)
    assert by_levels.achieved[1] == pytest.approx(58.0, abs=1e-9)  # 2 (49 - 30 / 1.5) N
    by_weights = WeightedAllocator(VEHICLE, AllocatorConfig()).step(Wrench(0, tau))[1]
    assert by_weights.achieved[5] == pytest.approx(11.9, abs=0.1)


def test_priorities_are_those_of_the_configuration():
    tau = np.array([0.0, 300.0, 0.0, 0.0, 0.0, 30.0])
    config = AllocatorConfig(priorities=[["K", "M"], ["Z"], ["X", "Y"], ["N"]])
    result = ThrustAllocator(VEHICLE, config).step(Wrench(0, tau))[1]
    assert result.achieved[[1, 5]] == pytest.approx([98.0, 0.0], abs=1e-9)


@settings(max_examples=100, deadline=None)
@given(shares=st.lists(st.floats(-1.0, 1.0), min_size=7, max_size=7))
def test_a_wrench_within_reach_is_exact_with_the_least_thrusts(shares):
    tau = MATRIX @ (REFERENCE.limits * np.array(shares))
    result = REFERENCE.step(Wrench(0, tau))[1]
    assert np.allclose(result.achieved, tau, atol=1e-9)
    least = REFERENCE.limits * (np.linalg.pinv(MATRIX * REFERENCE.limits) @ tau)
    if (np.abs(least) <= REFERENCE.limits).all():
        assert np.allclose(result.thrust, least, atol=1e-9)


def test_too_many_steps_are_reported():
    rows, work = np.eye(2), workspace(2, 2)
    steps = solve_levels(
        rows, np.array([1, 2]), np.full(2, 9.0), -np.ones(2), np.ones(2), np.zeros(2), *work, 1
    )
    assert steps == TOO_MANY_STEPS


def test_an_axis_that_depends_on_others_is_left_to_the_hull():
    """The heave thruster 6.7 cm ahead pitches as it heaves: heave is followed, pitch is not."""
    vehicle = load_vehicle("reference_auv_three_thrusters")
    allocator = ThrustAllocator(vehicle, AllocatorConfig())
    assert allocator.axes_left_out == ("Y", "K", "M")
    result = allocator.step(Wrench(0, np.array([5.0, 3.0, 20.0, 1.0, 9.0, 2.0])))[1]
    assert result.achieved[[0, 2, 5]] == pytest.approx([5.0, 20.0, 2.0], abs=1e-9)
    assert result.residual[4] == pytest.approx(9.0 + 20.0 * 0.067, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(shares=st.lists(st.floats(-1.5, 1.5), min_size=6, max_size=6))
def test_preserving_the_direction_is_exact_and_takes_the_largest_share(shares):
    tau = GROSS * np.array(shares)
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig(preserve_direction=True))
    achieved = allocator.step(Wrench(0, tau))[1].achieved
    share = float(achieved @ tau) / max(float(tau @ tau), 1e-12)
    assert np.allclose(achieved, share * tau, atol=1e-6)
    more = min(1.0, share + 1e-6) * tau
    best = REFERENCE.step(Wrench(0, more))[1].achieved
    assert (
        share >= 1.0 - 1e-9
        or np.abs(tau).max() < 1e-3
        or np.abs((best - more) / GROSS).max() > 1e-9
    )


def test_priorities_that_are_no_priorities_are_refused():
    for levels, text in (
        ([["K", "M"], ["Z"], ["N"], ["X"]], "Y comes 0 times"),
        ([["K", "M"], ["Z", "K"], ["N"], ["X", "Y"]], "K comes 2 times"),
        ([["K", "M"], ["Q"], ["N"], ["X", "Y"]], "'X', 'Y', 'Z', 'K', 'M' or 'N'"),
        ([[], ["K", "M", "Z", "N", "X", "Y"]], "at least 1 item"),
    ):
        with pytest.raises(ValidationError, match=text):
            AllocatorConfig(priorities=levels)


@pytest.mark.parametrize(
    ("method", "cls"),
    [("lexicographic", ThrustAllocator), ("weighted_least_squares", WeightedAllocator)],
)
def test_methods_by_name(method, cls):
    assert type(create(AllocatorConfig(method=method), VEHICLE)) is cls
