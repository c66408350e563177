"""Simulations over time: one with its course, many at once, and what is refused."""

import numpy as np
import pytest
from random_vehicles import random_motion, random_vehicle

from uvms_core.errors import ConfigError
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation import PlantConfig, advance_batch, make_state, make_system, simulate
from uvms_dynamics.simulation.integrator import advance, make_scratch
from uvms_dynamics.simulation.plant.config import initial_state

STEP, STEPS = 0.002, 20
CURRENT = np.array([0.3, -0.2, 0.1])


def system_of(n):
    return make_system(random_vehicle(40 + n, n, neutral=True), CURRENT)


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
    each = zip(states, thrust, effort, strict=True)
    return np.array([simulate(system, *start, STEP, STEPS)[-1] for start in each])


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


def test_a_course_begins_at_its_start_and_goes_on_where_it_ended():
    system = system_of(3)
    x, thrust, effort = (array[0] for array in random_starts(system, 3, 1))
    whole = simulate(system, x, thrust, effort, STEP, STEPS)
    assert whole.shape == (STEPS + 1, len(x))
    np.testing.assert_array_equal(whole[0], x)
    middle = simulate(system, x, thrust, effort, STEP, 8)[-1]
    rest = simulate(system, middle, thrust, effort, STEP, STEPS - 8)
    np.testing.assert_array_equal(rest[-1], whole[-1])


def test_a_made_state_is_the_plants_at_rest():
    vehicle = load_vehicle()
    config = PlantConfig(initial_position_m=(1.0, 2.0, 3.0))
    made = make_state(
        np.radians(vehicle.arm.stowed_deg), vehicle.n_thrusters, position=(1.0, 2.0, 3.0)
    )
    np.testing.assert_array_equal(made, initial_state(vehicle, config))


@pytest.mark.parametrize("step", [0.0, -0.005, np.nan, np.inf])
def test_a_step_that_is_none_is_refused(step):
    system = system_of(1)
    given = random_starts(system, 1, 2)
    with pytest.raises(ConfigError, match=r"step: .* s; must be finite and > 0"):
        advance_batch(system, *given, step, STEPS)
    with pytest.raises(ConfigError, match="step: "):
        simulate(system, *(array[0] for array in given), step, STEPS)


@pytest.mark.parametrize(
    "change",
    [
        {"x": -1},
        {"thrust_command": -1},
        {"effort": 1},
        {"states": -3},
        {"rates": 1},
    ],
    ids=lambda change: next(iter(change)),
)
def test_the_integrator_refuses_tables_that_do_not_fit(change):
    system = system_of(3)
    x, thrust, effort = (array[0] for array in random_starts(system, 3, 1))
    tables = {"states": np.empty((5, len(x))), "rates": np.empty((5, len(x)))}
    arrays = {"x": x, "thrust_command": thrust, "effort": effort, **tables}
    for name, by in change.items():
        shape = arrays[name].shape
        arrays[name] = np.zeros((*shape[:-1], shape[-1] + by))
    with pytest.raises(ValueError, match="need"):
        advance(system, step=STEP, scratch=make_scratch(system), time=0.0, **arrays)


def test_a_current_of_two_numbers_and_steps_backwards_are_refused():
    system = system_of(3)
    given = random_starts(system, 3, 4)
    with pytest.raises(ConfigError, match=r"current: has shape \(2,\), needs \(3,\)"):
        advance_batch(system._replace(current=np.zeros(2)), *given, STEP, STEPS)
    with pytest.raises(ConfigError, match="steps: -1 is negative"):
        advance_batch(system, *given, STEP, -1)
