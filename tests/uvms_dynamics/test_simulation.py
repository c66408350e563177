"""Many simulations at once are the same simulations one by one."""

import numpy as np
import pytest
from random_vehicles import random_motion, random_vehicle

from uvms_dynamics import System, advance_batch, build_model, build_thrusters
from uvms_dynamics.errors import ConfigError
from uvms_dynamics.integrator import advance, make_scratch

STEP, STEPS = 0.002, 20
CURRENT = np.array([0.3, -0.2, 0.1])


def system_of(n):
    vehicle = random_vehicle(40 + n, n, neutral=True)
    return System(build_model(vehicle), build_thrusters(vehicle), CURRENT)


def random_starts(system, n, count):
    """States with the joints on both sides of their stops, and commands beyond all limits."""
    rng, m = np.random.default_rng(n), len(system.thrusters)
    states = []
    for _ in range(count):
        motion = random_motion(rng, n)
        thrust = rng.normal(scale=30.0, size=m)
        place = rng.normal(size=3)
        states.append(
            np.concatenate([place, motion.quat, motion.nu, motion.q, 0.3 * motion.q_dot, thrust])
        )
    return np.array(states), rng.normal(scale=100.0, size=(count, m)), rng.normal(size=(count, n))


def one_by_one(system, states, thrust, effort):
    scratch, out = make_scratch(system), states.copy()
    table = np.empty((2, STEPS + 1, states.shape[1]))
    for x, command, torque in zip(out, thrust, effort, strict=True):
        advance(system, x, command, torque, STEP, scratch, *table)
    return out


@pytest.mark.parametrize("n", [1, 3, 4, 9])
@pytest.mark.parametrize("count", [1, 8, 19])
def test_each_goes_as_it_would_alone(n, count):
    system = system_of(n)
    states, thrust, effort = random_starts(system, n, count)
    expected = one_by_one(system, states, thrust, effort)
    found = advance_batch(system, states, thrust, effort, STEP, STEPS)
    assert np.abs(found - states).max() > 0.01  # they went somewhere
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-9)


def test_neither_its_neighbours_nor_its_place_change_a_simulation():
    system = system_of(3)
    states, thrust, effort = random_starts(system, 3, 24)
    order = np.random.default_rng(0).permutation(24)
    straight = advance_batch(system, states, thrust, effort, STEP, STEPS)
    mixed = advance_batch(system, states[order], thrust[order], effort[order], STEP, STEPS)
    np.testing.assert_array_equal(mixed, straight[order])


def test_one_that_diverges_does_not_take_others_with_it():
    system = system_of(3)
    states, thrust, effort = random_starts(system, 3, 8)
    broken = states.copy()
    broken[5, 8] = np.nan
    found = advance_batch(system, broken, thrust, effort, STEP, STEPS)
    whole = advance_batch(system, states, thrust, effort, STEP, STEPS)
    others = np.arange(8) != 5
    assert np.isnan(found[5]).any()
    np.testing.assert_array_equal(found[others], whole[others])


def test_the_arrays_given_stay_as_they_are():
    system = system_of(1)
    given = random_starts(system, 1, 5)
    before = [array.copy() for array in given]
    advance_batch(system, *given, STEP, STEPS)
    for array, copy in zip(given, before, strict=True):
        np.testing.assert_array_equal(array, copy)


@pytest.mark.parametrize(("which", "name"), list(enumerate(("x", "thrust_command", "effort"))))
def test_a_wrong_shape_is_named(which, name):
    system = system_of(3)
    given = list(random_starts(system, 3, 4))
    given[which] = given[which][:, :-1]
    with pytest.raises(ConfigError, match=rf"{name}: has shape .*, needs \(4, "):
        advance_batch(system, *given, STEP, STEPS)


def test_a_current_of_two_numbers_and_steps_backwards_are_refused():
    system = system_of(3)
    given = random_starts(system, 3, 4)
    with pytest.raises(ConfigError, match=r"current: has shape \(2,\), needs \(3,\)"):
        advance_batch(system._replace(current=np.zeros(2)), *given, STEP, STEPS)
    with pytest.raises(ConfigError, match="steps: -1 is negative"):
        advance_batch(system, *given, STEP, -1)
