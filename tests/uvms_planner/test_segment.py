import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planner_rig import START, solver_of
from scipy.spatial.transform import Rotation

from uvms_dynamics import coupling_wrench, restoring_wrench
from uvms_planner.segment import Knot, evaluate, hermite, quintic, reference

numbers = st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6)


@given(numbers, st.floats(0.1, 10.0))
@settings(max_examples=60, deadline=None)
def test_a_quintic_has_the_given_value_rate_and_acceleration_at_both_ends(values, duration):
    states = [np.array([value]) for value in values]
    coefficients = quintic(tuple(states[:3]), tuple(states[3:]), duration)
    samples = evaluate(coefficients, np.array([0.0, duration]))
    got = [samples.configuration, samples.rate, samples.acceleration]
    for order in range(3):
        scale = 1 + max(1.0, duration) ** 2 / min(1.0, duration) ** 2
        assert got[order][0, 0] == pytest.approx(values[order], abs=1e-9 * scale)
        assert got[order][1, 0] == pytest.approx(values[3 + order], abs=1e-9 * scale)


def test_constant_acceleration_is_kept_exactly():
    rate, bend, h = np.array([0.3]), np.array([-0.2]), 0.5
    start = Knot(0, np.array([1.0]), rate, bend, rate)
    end = Knot(1, 1.0 + rate * h + bend * h**2 / 2, rate + bend * h, bend, rate)
    times = np.linspace(0, h, 11)
    samples = hermite(start, end, h, times)
    assert np.allclose(samples.configuration[:, 0], 1 + 0.3 * times - 0.1 * times**2)
    assert np.allclose(samples.acceleration, -0.2)


def test_a_reference_is_consistent_in_all_its_derivatives():
    model = solver_of().model
    rng = np.random.default_rng(4)
    end = START + 0.1 * rng.normal(size=8)
    knots = [
        Knot(0, START, 0.2 * rng.normal(size=8), 0.3 * rng.normal(size=8), START),
        Knot(1, end, 0.2 * rng.normal(size=8), 0.3 * rng.normal(size=8), START),
    ]
    times = np.linspace(0.0, 0.5, 5001)
    signal = reference(model, 0, times, hermite(*knots, 0.5, times))
    step = times[1]
    turns = Rotation.from_quat(signal.quaternion)
    velocity = turns.inv().apply(np.gradient(signal.position, step, axis=0))
    assert np.allclose(velocity[1:-1], signal.nu[1:-1, :3], atol=1e-6)
    turning = (turns[:-2].inv() * turns[2:]).as_rotvec() / (2 * step)
    assert np.allclose(turning, signal.nu[1:-1, 3:], atol=1e-6)
    for first, second in ((signal.nu, signal.nu_dot), (signal.q, signal.q_dot)):
        assert np.allclose(np.gradient(first, step, axis=0)[1:-1], second[1:-1], atol=1e-5)
    assert np.allclose(
        np.gradient(signal.q_dot, step, axis=0)[1:-1], signal.q_ddot[1:-1], atol=1e-5
    )


def test_a_reference_says_what_its_motion_does_to_the_vehicle():
    """Its wrenches are those of its own samples, and to hold still takes its weight alone."""
    model = solver_of().model
    rng = np.random.default_rng(5)
    end = START + 0.1 * rng.normal(size=8)
    knots = [
        Knot(0, START, 0.2 * rng.normal(size=8), 0.3 * rng.normal(size=8), START),
        Knot(1, end, 0.2 * rng.normal(size=8), 0.3 * rng.normal(size=8), START),
    ]
    times = np.linspace(0.0, 0.5, 6)
    signal = reference(model, 0, times, hermite(*knots, 0.5, times))
    for k in range(len(times)):
        own = signal.nu[k], signal.nu_dot[k], signal.q[k], signal.q_dot[k], signal.q_ddot[k]
        restoring = restoring_wrench(model, signal.quaternion[k], signal.q[k])
        np.testing.assert_allclose(signal.disturbance.restoring[k], restoring, atol=1e-9)
        coupling = coupling_wrench(model, *own)
        np.testing.assert_allclose(signal.disturbance.coupling[k], coupling, atol=1e-9)
    still = Knot.at_rest(0, START)
    held = reference(model, 0, times, hermite(still, still, 0.5, times)).disturbance
    assert np.abs(held.coupling).max() < 1e-12
    assert np.abs(held.restoring).max() > 0.1
