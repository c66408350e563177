"""Thrust allocation: exact when feasible, optimal when not, never beyond the limits."""

import numpy as np
import pytest
import quadprog
from hypothesis import example, given, settings
from hypothesis import strategies as st

from uvms_control.allocation import (
    WeightedAllocator,
    axes_without_authority,
)
from uvms_control.config import AllocatorConfig
from uvms_control.errors import ControlSetupError
from uvms_core.errors import SignalError
from uvms_core.signals import Wrench, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import configuration_matrix

VEHICLE = load_vehicle()
REFERENCE = WeightedAllocator(VEHICLE, AllocatorConfig())
MATRIX, LIMITS = REFERENCE.matrix, REFERENCE.limits
AUTHORITY = np.array([98.0, 98.0, 196.0, 19.6, 107.8, 73.5])
wrenches = st.lists(st.floats(-1.5, 1.5), min_size=6, max_size=6).map(
    lambda shares: AUTHORITY * np.array(shares)
)


def allocate(tau, **options):
    return WeightedAllocator(VEHICLE, AllocatorConfig(**options)).step(Wrench(0, np.array(tau)))[1]


def random_layout(seed, m):
    rng = np.random.default_rng(seed)
    directions = rng.normal(size=(m, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return configuration_matrix(rng.uniform(-1.0, 1.0, (m, 3)), directions), rng.uniform(
        10.0, 100.0, m
    )


def test_the_reference_vehicle_has_the_authority_its_data_sheet_states():
    assert np.allclose(REFERENCE.authority, AUTHORITY, atol=1e-6)
    assert np.linalg.matrix_rank(MATRIX) == 6
    assert REFERENCE.axes_without_authority == ()
    assert REFERENCE.warning is None


@pytest.mark.parametrize("axis", range(6))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_full_authority_on_one_axis_is_reached_exactly(axis, sign):
    tau = np.zeros(6)
    tau[axis] = sign * AUTHORITY[axis]
    result = allocate(tau)
    assert np.allclose(result.achieved, tau, atol=1e-4)
    used = np.abs(MATRIX[axis]) > 0.0
    assert np.allclose(np.abs(result.thrust[used]), LIMITS[used], atol=1e-3)


@settings(max_examples=200, deadline=None)
@given(shares=st.lists(st.floats(-1.0, 1.0), min_size=7, max_size=7))
def test_a_feasible_wrench_is_met(shares):
    tau = MATRIX @ (LIMITS * np.array(shares))
    result = allocate(tau)
    assert np.allclose(result.achieved, tau, atol=1e-4)


@settings(max_examples=200, deadline=None)
@given(tau=wrenches)
def test_limits_hold_and_achieved_plus_residual_is_the_command(tau):
    result = allocate(tau)
    assert np.all(np.abs(result.thrust) <= LIMITS)
    assert np.allclose(result.achieved, MATRIX @ result.thrust, atol=1e-12)
    assert np.allclose(result.achieved + result.residual, tau, rtol=1e-12, atol=1e-12)
    at_limit = np.abs(result.thrust) >= LIMITS * (1.0 - 1e-9)
    assert np.array_equal(result.saturated, at_limit)


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 12), tau=wrenches)
def test_any_layout_gives_the_weighted_least_squares_thrust(seed, m, tau):
    matrix, limits = random_layout(seed, m)
    config = AllocatorConfig(regularisation=1e-4)
    allocator = WeightedAllocator.from_layout(matrix, limits, np.full(m, 1e3), config)
    result = allocator.step(Wrench(0, tau))[1]
    rows = np.array(config.weights) / (np.abs(matrix) @ limits)
    stacked = np.vstack([rows[:, None] * matrix * limits, 1e-2 * np.eye(m)])
    rhs = np.concatenate([rows * tau, np.zeros(m)])
    # quadprog (Goldfarb-Idnani): scipy's bvls stopped short of the optimum on one such problem.
    box = np.hstack([np.eye(m), -np.eye(m)])
    reference = quadprog.solve_qp(stacked.T @ stacked, stacked.T @ rhs, box, -np.ones(2 * m))[0]
    assert np.allclose(result.thrust, limits * reference, atol=1e-5 * limits.max())


@settings(max_examples=200, deadline=None)
@given(first=wrenches, second=wrenches)
def test_the_achieved_wrench_never_moves_further_than_the_command(first, second):
    """A projection does not expand distances, hence the allocation is continuous."""
    rows = np.array(AllocatorConfig().weights) / AUTHORITY
    moved = rows * (allocate(first).achieved - allocate(second).achieved)
    assert np.linalg.norm(moved) <= np.linalg.norm(rows * (first - second)) + 1e-9


@settings(max_examples=100, deadline=None)
@given(tau=wrenches, direction=wrenches)
def test_thrusts_move_little_for_a_little_change_of_the_command(tau, direction):
    before = allocate(tau).thrust
    after = allocate(tau + 1e-6 * direction).thrust
    assert np.max(np.abs(after - before)) < 1e-2


@settings(max_examples=50, deadline=None)
@given(start=wrenches, goal=wrenches)
@example(  # a wrong multiplier of 1e-12 of the gradient's terms is 0.03 N among four verticals
    start=AUTHORITY * np.array([0.0, 0.0, 0.271484375, -0.5536660605609856, 0.869140625, 0.0]),
    goal=AUTHORITY * np.array([0.0, 0.0, -1.5, 0.626953125, -0.126953125, 0.0]),
)
def test_a_warm_start_changes_nothing(start, goal):
    allocator = WeightedAllocator(VEHICLE, AllocatorConfig())
    for k, share in enumerate(np.linspace(0.0, 1.0, 9)):
        tau = (1.0 - share) * start + share * goal
        warm = allocator.step(Wrench(k, tau))[1].thrust
        assert np.allclose(warm, allocate(tau).thrust, atol=1e-4)


def test_roll_and_pitch_keep_their_moment_when_thrusters_saturate():
    tau = np.array([0.0, 0.0, 190.0, 15.0, 20.0, 0.0])
    result = allocate(tau)
    assert result.saturated.any()
    assert np.all(np.abs(result.residual[3:5]) < 0.03 * np.abs(tau[3:5]))
    assert result.residual[2] > 40.0
    flat = allocate(tau, weights=(1.0,) * 6)
    assert np.abs(flat.residual[3]) > 4.0 * np.abs(result.residual[3])


@settings(max_examples=60, deadline=None)
@given(tau=wrenches)
def test_preserving_the_direction_scales_the_whole_wrench(tau):
    achieved = allocate(tau, preserve_direction=True).achieved
    share = float(achieved @ tau) / max(float(tau @ tau), 1e-12)
    assert -1e-9 <= share <= 1.0 + 1e-6
    assert np.allclose(achieved, share * tau, atol=2e-4 * AUTHORITY)


def test_preserving_the_direction_gives_the_largest_share():
    result = allocate((0.0, 0.0, 392.0, 0.0, 0.0, 0.0), preserve_direction=True)
    assert np.allclose(result.achieved, (0.0, 0.0, 196.0, 0.0, 0.0, 0.0), atol=1e-3)


def test_slew_awareness_bounds_the_change_in_a_tick():
    matrix, limits = random_layout(1, 8)
    slew = np.full(8, 40.0)
    config = AllocatorConfig(slew_aware=True)
    allocator = WeightedAllocator.from_layout(matrix, limits, slew, config)
    thrust = allocator.step(Wrench(0, np.zeros(6)))[1].thrust
    for k in range(1, 60):
        result = allocator.step(Wrench(to_nanoseconds(0.05 * k), np.array([20.0] * 6)))[1]
        assert np.all(np.abs(result.thrust - thrust) <= 2.0 + 1e-9)
        thrust = result.thrust
    free = WeightedAllocator.from_layout(matrix, limits, slew, AllocatorConfig())
    assert np.allclose(thrust, free.step(Wrench(0, np.array([20.0] * 6)))[1].thrust, atol=1e-4)


def test_axes_without_authority_are_named():
    verticals = configuration_matrix(
        np.array([[0.5, 0.1, 0.0], [0.5, -0.1, 0.0], [-0.5, 0.0, 0.0]]),
        np.tile([0.0, 0.0, 1.0], (3, 1)),
    )
    allocator = WeightedAllocator.from_layout(
        verticals, np.full(3, 49.0), np.full(3, 100.0), AllocatorConfig()
    )
    assert allocator.axes_without_authority == ("X", "Y", "N")
    assert allocator.warning == (
        "the 3 thrusters cannot push independently along X, Y, N; commands there leave a residual"
    )
    assert np.allclose(allocator.authority[[0, 1, 5]], 0.0)
    result = allocator.step(Wrench(0, np.array([10.0, 0.0, 30.0, 0.0, 0.0, 0.0])))[1]
    assert np.allclose(result.residual, (10.0, 0.0, 0.0, 0.0, 0.0, 0.0), atol=1e-4)


def test_coupled_axes_count_as_without_authority():
    one = configuration_matrix(np.array([[0.0, 1.0, 0.0]]), np.array([[1.0, 0.0, 0.0]]))
    assert axes_without_authority(one) == ("X", "Y", "Z", "K", "M", "N")


def test_safe_command_is_zero_and_forgets_the_past():
    allocator = WeightedAllocator(VEHICLE, AllocatorConfig(slew_aware=True))
    allocator.step(Wrench(0, 0.3 * AUTHORITY))
    command, result = allocator.safe(7)
    assert command.stamp == result.stamp == 7
    assert not command.thrust.any()
    assert not result.achieved.any()
    assert not result.saturated.any()


def test_a_wrench_that_is_not_finite_is_named():
    tau = np.zeros(6)
    tau[4] = np.nan
    with pytest.raises(SignalError) as error:
        REFERENCE.step(Wrench(0, tau))
    assert str(error.value) == "wrench_command.wrench[4] is nan; it must be finite"
    with pytest.raises(SignalError) as error:
        REFERENCE.step(Wrench(0, np.zeros(5)))
    assert str(error.value) == "wrench_command.wrench has shape (5,); it must have (6,)"


def test_a_wrong_layout_is_named():
    with pytest.raises(ControlSetupError) as error:
        WeightedAllocator.from_layout(
            np.zeros((6, 2)), np.array([1.0, -1.0]), np.ones(2), AllocatorConfig()
        )
    assert str(error.value) == "thruster limits: [ 1. -1.], expected positive numbers"


def test_axes_that_can_be_pushed_one_way_only_are_named():
    changes = {f"thrusters.{i}.limit_n": None for i in range(VEHICLE.n_thrusters)}
    changes |= {f"thrusters.{i}.limits_n": [0.0, 49.0] for i in range(len(changes))}
    allocator = WeightedAllocator(load_vehicle(None, changes), AllocatorConfig())
    assert allocator.axes_without_authority == ()
    assert "X (only +)" in allocator.axes_pushed_one_way
    assert "both ways along" in allocator.warning
    assert "X (only +)" in allocator.warning
    assert REFERENCE.axes_pushed_one_way == ()
