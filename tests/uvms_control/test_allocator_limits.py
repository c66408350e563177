"""Thrust allocation within limits that differ by direction, and around thrusts nobody can give."""

import daqp
import numpy as np
import pytest
import quadprog
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_control.allocation import WeightedAllocator, axis_authority
from uvms_control.config import AllocatorConfig
from uvms_control.errors import ControlSetupError
from uvms_core.signals import Wrench
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.thrust_curve import nearest_reachable
from uvms_dynamics import configuration_matrix

BLUEROV = load_vehicle("bluerov2_alpha5")
SURGE = np.array([[1.0], [0.0], [0.0], [0.0], [0.0], [0.0]])


def layout(rng, m):
    directions = rng.normal(size=(m, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    matrix = configuration_matrix(rng.uniform(-1.0, 1.0, (m, 3)), directions)
    astern = -rng.uniform(0.0, 60.0, m) * (rng.random(m) > 0.2)  # some do not reverse
    return matrix, np.vstack([astern, rng.uniform(10.0, 100.0, m)])


def surge(force):
    return np.array([force, 0.0, 0.0, 0.0, 0.0, 0.0])


def along_surge(count, limits, least, **options):
    """Allocator of thrusters that all push ahead."""
    config = AllocatorConfig(**options)
    slew, ends = np.full(count, 1e3), np.tile(np.array(limits)[:, None], count)
    least = np.tile(np.array(least)[:, None], count)
    return WeightedAllocator.from_layout(np.tile(SURGE, count), ends, slew, config, least)


@settings(max_examples=100, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 12))
def test_any_limits_give_the_weighted_least_squares_thrust(seed, m):
    rng = np.random.default_rng(seed)
    matrix, limits = layout(rng, m)
    scale = np.abs(limits).max(axis=0)
    tau = 1.5 * rng.uniform(-1.0, 1.0, 6) * (np.abs(matrix) @ scale)
    config = AllocatorConfig(regularisation=1e-4)
    allocator = WeightedAllocator.from_layout(matrix, limits, np.full(m, 1e3), config)
    thrust = allocator.step(Wrench(0, tau))[1].thrust
    rows = np.array(config.weights) / (np.abs(matrix) @ scale)
    stacked = np.vstack([rows[:, None] * matrix * scale, 1e-2 * np.eye(m)])
    hessian, linear = stacked.T @ stacked, stacked.T @ np.append(rows * tau, np.zeros(m))
    low, high = limits / scale
    box = np.hstack([np.eye(m), -np.eye(m)])
    first = quadprog.solve_qp(hessian, linear, box, np.append(low, -high))[0]
    none, sense = np.zeros((0, m)), np.zeros(m, dtype=np.int32)
    second = daqp.solve(hessian, -linear, none, high.copy(), low.copy(), sense)[0]
    assert np.allclose(thrust, scale * first, atol=1e-5 * scale.max())
    assert np.allclose(thrust, scale * second, atol=1e-4 * scale.max())
    assert (thrust >= limits[0]).all()
    assert (thrust <= limits[1]).all()


def test_limits_astern_are_negative():
    with pytest.raises(ControlSetupError, match=r"thruster limits astern: \[2\.\], expected none"):
        along_surge(1, (2.0, 50.0), (0.0, 0.0))


def test_authority_differs_by_direction():
    matrix = np.hstack([SURGE, SURGE])
    limits = np.array([[-30.0, 0.0], [50.0, 20.0]])
    assert axis_authority(matrix, limits)[0] == pytest.approx(70.0)
    assert axis_authority(-matrix, limits)[0] == pytest.approx(30.0)


def test_a_thruster_that_does_not_reverse_is_not_saturated_when_it_rests():
    allocator = along_surge(1, (0.0, 50.0), (0.0, 0.0))
    result = allocator.step(Wrench(0, surge(0.0)))[1]
    assert not result.saturated.any()
    back = allocator.step(Wrench(1, surge(-10.0)))[1]
    assert back.thrust[0] == 0.0
    assert back.residual[0] == -10.0


@pytest.mark.parametrize(
    ("wanted", "expected"),
    [(0.0, 0.0), (0.4, 0.0), (0.6, 1.0), (1.2, 1.2), (-0.9, -2.0), (-0.7, 0.0), (-3.0, -3.0)],
)
def test_a_thrust_in_the_gap_becomes_none_or_the_least(wanted, expected):
    """One thruster, least thrusts 2 N astern and 1 N ahead; it starts beyond 0.54 of them."""
    wanted *= 1.3 if wanted == -0.9 else 1.0
    result = along_surge(1, (-50.0, 50.0), (-2.0, 1.0)).step(Wrench(0, surge(wanted)))[1]
    assert result.thrust[0] == pytest.approx(expected, abs=1e-6)
    assert result.achieved[0] == result.thrust[0]
    assert result.residual[0] == pytest.approx(wanted - result.thrust[0])


def test_others_make_up_for_a_thruster_in_its_gap():
    """Two side by side: a quarter of a newton of each becomes half a newton of one."""
    result = along_surge(2, (-50.0, 50.0), (-0.4, 0.4)).step(Wrench(0, surge(0.5)))[1]
    assert sorted(result.thrust) == pytest.approx([0.0, 0.5], abs=1e-5)
    assert result.achieved[0] == pytest.approx(0.5, abs=1e-6)


def test_noise_about_the_middle_of_a_gap_does_not_switch_the_thruster():
    allocator, rng = along_surge(1, (-50.0, 50.0), (-1.0, 1.0)), np.random.default_rng(1)
    wanted = np.concatenate([np.linspace(0.0, 1.0, 200), np.linspace(1.0, 0.0, 200)])
    wanted += 0.01 * rng.standard_normal(400)
    thrust = [allocator.step(Wrench(k, surge(w)))[1].thrust[0] for k, w in enumerate(wanted)]
    turns = np.array(thrust) > 0.5
    assert np.count_nonzero(np.diff(turns)) == 2
    started, stopped = wanted[np.argmax(turns)], wanted[399 - np.argmax(turns[::-1]) + 1]
    assert started == pytest.approx(0.545, abs=0.03)  # (1 - x)^2 = 0.7 x^2
    assert stopped == pytest.approx(0.455, abs=0.03)


@settings(max_examples=60, deadline=None)
@given(seed=st.integers(0, 2**31), m=st.integers(1, 8))
def test_no_thrust_is_left_in_a_gap_and_rounding_alone_would_be_worse(seed, m):
    """Small wrenches in random layouts, against stopping or starting each thruster on its own."""
    rng = np.random.default_rng(seed)
    matrix, limits = layout(rng, m)
    least = np.vstack([0.02 * limits[0], 0.02 * limits[1]])
    config, slew = AllocatorConfig(), np.full(m, 1e3)
    smooth = WeightedAllocator.from_layout(matrix, limits, slew, config)
    allocator = WeightedAllocator.from_layout(matrix, limits, slew, config, least)
    tau = matrix @ (0.04 * rng.uniform(*limits))
    thrust, wanted = (each.step(Wrench(0, tau))[1].thrust for each in (allocator, smooth))
    nearest = np.where(wanted > 0.0, least[1], least[0])
    in_gap = (wanted < least[1]) & (wanted > least[0])
    starts = np.abs(wanted) > 0.5 * np.abs(nearest)
    rounded = np.where(in_gap, np.where(starts, nearest, 0.0), wanted)
    assert not (((thrust < 0.999 * least[1]) & (thrust > 0.0)).any())
    assert not (((thrust > 0.999 * least[0]) & (thrust < 0.0)).any())
    rows = np.array(config.weights) / (np.abs(matrix) @ np.abs(limits).max(axis=0))
    errors = [float(np.linalg.norm(rows * (matrix @ each - tau))) for each in (thrust, rounded)]
    assert errors[0] <= errors[1] / np.sqrt(0.7) + 2e-5


def test_the_bluerov_is_allocated_what_its_t200_can_give():
    allocator = WeightedAllocator(BLUEROV, AllocatorConfig())
    rng = np.random.default_rng(4)
    for k in range(300):
        tau = rng.normal(size=6) * [20.0, 20.0, 10.0, 0.5, 0.0, 2.0] * rng.choice([0.02, 1.0, 9.0])
        thrust = allocator.step(Wrench(k, tau))[1].thrust
        for part, value in zip(BLUEROV.thrusters, thrust, strict=True):
            assert float(part.reachable(value)) == pytest.approx(value, abs=1e-6)


def test_the_same_wrench_and_none_after_it():
    allocator = WeightedAllocator(BLUEROV, AllocatorConfig())
    first = allocator.step(Wrench(0, surge(30.0)))[1]
    second = allocator.step(Wrench(1, surge(30.0)))[1]
    np.testing.assert_allclose(first.thrust, second.thrust, atol=1e-6)
    assert not allocator.safe(2)[1].thrust.any()


@settings(deadline=None)
@given(wanted=st.floats(-20.0, 20.0))
def test_rounding_out_of_a_gap_is_that_of_the_thrust_curve(wanted):
    """For one thruster alone to make up for nothing is the same as to round."""
    allocator = along_surge(1, (-30.0, 40.0), (-3.0, 2.0), slew_aware=False, regularisation=1e-10)
    thrust = allocator.step(Wrench(0, surge(wanted)))[1].thrust[0]
    middle = min(abs(wanted - 1.0), abs(wanted + 1.5))
    if middle > 0.1 * abs(wanted):  # in the middle of a gap a thruster stays as it was
        assert thrust == pytest.approx(float(nearest_reachable(wanted, -3.0, 2.0)), abs=1e-6)
