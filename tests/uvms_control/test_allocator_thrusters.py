"""Failed thrusters and lag, for either method of allocation."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_control.allocation import ThrustAllocator, WeightedAllocator
from uvms_control.allocation.lag import SLEW_ERROR, thrust_delay
from uvms_control.config import AllocatorConfig
from uvms_core.errors import SignalError
from uvms_core.signals import Wrench, to_nanoseconds
from uvms_core.vehicle import load_vehicle
from uvms_observer.disturbance.thrust_lag import ThrustLag

VEHICLE, BLUEROV = load_vehicle(), load_vehicle("bluerov2_alpha5")
PERIOD = 0.05
LAGS = np.array([part.time_constant_s for part in VEHICLE.thrusters])
methods = pytest.mark.parametrize("cls", [ThrustAllocator, WeightedAllocator])
shares = st.lists(st.sampled_from([0.0, 0.03, 0.2, 0.5, 1.0]), min_size=7, max_size=7)


def at(k, tau):
    return Wrench(to_nanoseconds(PERIOD * k), np.array(tau, dtype=float))


def follow(thrust, command, steps=2000):
    """A period of thrusters by Euler's method: lag within the slew limit. (end, mean)."""
    slew = np.array([part.slew_limit_n_s for part in VEHICLE.thrusters])
    total, h = np.zeros_like(thrust), PERIOD / steps
    for _ in range(steps):
        total += thrust
        thrust = thrust + h * np.clip((command - thrust) / LAGS, -slew, slew)
    return thrust, total / steps


@methods
@settings(max_examples=40, deadline=None)
@given(effectiveness=shares, seed=st.integers(0, 2**31))
def test_dead_thrusters_are_left_out_and_weak_ones_get_more(cls, effectiveness, seed):
    allocator = cls(VEHICLE, AllocatorConfig(lag_compensation=0.0))
    tau = 0.3 * np.random.default_rng(seed).uniform(-1.0, 1.0, 6) * allocator._gross
    allocator.step(at(0, tau))
    allocator.set_effectiveness(np.array(effectiveness))
    result = allocator.step(at(1, tau))[1]
    gives = np.where(np.array(effectiveness) < 0.05, 0.0, effectiveness)
    assert np.array_equal(result.effectiveness, gives)
    assert not result.thrust[gives == 0.0].any()
    assert not result.saturated[gives == 0.0].any()
    assert np.allclose(result.achieved, allocator.matrix @ (gives * result.thrust), atol=1e-9)
    assert np.allclose(result.achieved + result.residual, tau, atol=1e-9)
    assert (np.abs(result.thrust) <= allocator.limits).all()


@pytest.mark.parametrize("index", range(7))
def test_one_dead_thruster_costs_no_axis_that_can_be_had_without_it(index):
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig())
    effectiveness = np.ones(7)
    effectiveness[index] = 0.0
    allocator.set_effectiveness(effectiveness)
    tau = np.array([10.0, 5.0, -8.0, 1.0, -3.0, 2.0])
    residual = allocator.step(at(0, tau))[1].residual
    lost = {0: ("X",), 1: ("Y",), 2: ("Y",)}.get(index, ())
    assert allocator.axes_left_out == lost
    kept = ["XYZKMN".index(axis) for axis in "XYZKMN" if axis not in lost]
    assert np.allclose(residual[kept], 0.0, atol=1e-9)


def test_a_thruster_that_dies_under_a_slew_limit_gets_no_command():
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig(slew_aware=True))
    for k in range(20):
        allocator.step(at(k, [90.0, 0.0, 0.0, 0.0, 0.0, 0.0]))
    allocator.set_effectiveness(np.array([0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]))
    assert allocator.step(at(20, [90.0, 0.0, 0.0, 0.0, 0.0, 0.0]))[1].thrust[0] == 0.0


@methods
def test_weak_thrusters_stay_out_of_their_gaps(cls):
    allocator, rng = cls(BLUEROV, AllocatorConfig()), np.random.default_rng(4)
    allocator.set_effectiveness(np.array([1.0, 0.4, 1.0, 0.0, 0.7, 1.0]))
    for k in range(200):
        tau = rng.normal(size=6) * [20.0, 20.0, 10.0, 0.5, 0.0, 2.0] * rng.choice([0.02, 1.0, 9.0])
        thrust = allocator.step(at(k, tau))[1].thrust
        assert thrust[3] == 0.0
        for part, value in zip(BLUEROV.thrusters, thrust, strict=True):
            assert float(part.reachable(value)) == pytest.approx(value, abs=1e-6)


def test_a_share_that_is_none_is_refused():
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig())
    with pytest.raises(SignalError, match=r"effectiveness\[2\] is 1.3; it must be in 0 to 1.2"):
        allocator.set_effectiveness(np.array([1.0, 1.0, 1.3, 1.0, 1.0, 1.0, 1.0]))
    with pytest.raises(SignalError, match=r"effectiveness\[0\] is nan"):
        allocator.set_effectiveness(np.array([np.nan] * 7))
    with pytest.raises(SignalError, match=r"shape \(2,\); it must have \(7,\)"):
        allocator.set_effectiveness(np.ones(2))


def test_with_all_of_the_lag_compensated_the_wanted_thrust_is_there_at_the_end():
    config = AllocatorConfig(lag_compensation=True)
    allocator, rng = ThrustAllocator(VEHICLE, config), np.random.default_rng(2)
    thrust, tau = np.zeros(7), np.zeros(6)
    for k in range(40):
        tau = 0.9 * tau + 0.02 * rng.uniform(-1.0, 1.0, 6) * allocator._gross
        result = allocator.step(at(k, tau))[1]
        thrust, _ = follow(thrust, result.thrust)
        if k > 0:  # the period is not known before
            assert np.abs(result.residual).max() < 1e-4
            assert np.allclose(allocator.matrix @ thrust, tau, atol=0.02)
            assert np.allclose(result.achieved, allocator.matrix @ result.thrust, atol=1e-9)


@pytest.mark.parametrize("is_told", [True, False])
def test_two_commands_close_together_do_not_make_the_commands_wild(is_told):
    """Stamps that jitter: the lag of a whole period is not made up for within a millisecond."""
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig(lag_compensation=1.0))
    if is_told:
        allocator.prepare(PERIOD)
    a = np.exp(-PERIOD / 0.15)
    most = 0.0
    for stamp_ms in (0, 50, 51, 100, 101, 150, 200):
        wanted = 1.0 if stamp_ms in (51, 101, 200) else 0.0
        wrench = Wrench(stamp_ms * 1_000_000, np.array([wanted, 0.0, 0.0, 0.0, 0.0, 0.0]))
        most = max(most, float(np.abs(allocator.step(wrench)[1].thrust).max()))
    assert most <= 2.0 / (1.0 - a)


def test_commands_ahead_of_the_thrust_stay_where_the_observer_knows_their_lag():
    """Steps that saturate: no slew limit acts, and `ThrustLag` has the mean wrench."""
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig(lag_compensation=1.0))
    lag, thrust, rng = ThrustLag(VEHICLE), np.zeros(7), np.random.default_rng(3)
    saturates, most = 0, 4 * SLEW_ERROR * 245.0 * 0.12 / (1.0 - np.exp(-PERIOD / 0.12))
    for k in range(30):
        tau = min(k, 1) * rng.uniform(-0.6, 0.6, 6) * allocator._gross
        result = allocator.step(at(k, tau))[1]
        thrust, mean = follow(thrust, result.thrust)
        assert (np.abs(result.thrust) <= allocator.limits).all()
        if k > 0:
            saturates += result.saturated.any()
            assert np.allclose(result.residual, tau - allocator.matrix @ thrust, atol=most)
        modelled = lag.step(PERIOD, result.achieved)
        if k > 0:
            assert np.allclose(modelled, allocator.matrix @ mean, atol=most)
    assert saturates > 10


@pytest.mark.parametrize("share", [0.0, 0.5, 1.0])
def test_what_is_left_of_the_delay_is_the_area_above_the_step_response(share):
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig(lag_compensation=share))
    thrust, area = np.zeros(7), 0.0
    allocator.step(at(0, np.zeros(6)))
    allocator.step(at(1, np.zeros(6)))
    for k in range(2, 60):
        thrust, mean = follow(thrust, allocator.step(at(k, [1.0, 0, 0, 0, 0, 0]))[1].thrust)
        area += PERIOD * (1.0 - mean[0])
    assert area == pytest.approx(float(thrust_delay(LAGS[0], PERIOD, share)), abs=1e-3)


def test_a_lost_command_does_not_change_the_compensation():
    allocator = ThrustAllocator(VEHICLE, AllocatorConfig(lag_compensation=1.0))
    thrust, ticks = np.zeros(7), [0, 1, 2, 3, 5, 6, 7]
    for k, after in zip(ticks, [*ticks[1:], 8], strict=True):
        result = allocator.step(at(k, [3.0 + k, 1.0, 2.0, 0.1, 0.5, 0.3]))[1]
        for _ in range(after - k):
            thrust, _ = follow(thrust, result.thrust)
        if k > 0 and after - k == 1:
            assert allocator.matrix @ thrust == pytest.approx(
                [3.0 + k, 1.0, 2.0, 0.1, 0.5, 0.3], abs=0.02
            )
