"""What a free system keeps: energy and momentum with the fluid's, at fourth order in the step."""

import numpy as np
import pytest
from free_run import FreeRun
from random_vehicles import REFERENCE, changed, random_vehicle

from uvms_dynamics.simulation.integrator import QUATERNION, VELOCITY

STEPS = np.array([0.02, 0.01, 0.005, 0.0025])
SEEDS = (3, 4, 5, 6)
VEHICLES = {
    "reference": lambda seed: changed(REFERENCE, drag=False),
    "1 joint": lambda seed: random_vehicle(seed, 1, drag=False, neutral=True),
    "3 joints": lambda seed: random_vehicle(seed, 3, drag=False, neutral=True),
}


@pytest.fixture(params=VEHICLES)
def without_drag(request):
    return VEHICLES[request.param]


def order(errors):
    """Slope of the errors (starts, steps) over the step, the median over the starts."""
    return np.median(np.polyfit(np.log(STEPS), np.log(errors).T, 1)[0])


def test_energy_of_a_minute_is_lost_at_fourth_order_in_the_step(without_drag):
    """Weight, buoyancy, added mass and rotors; some joules go to and fro all the time.

    The arm's motion is chaotic, so that single starts give slopes of 4.0 with a deviation of 0.6.
    """
    errors = []
    for seed in range(12):
        run = FreeRun(without_drag(seed), seed, rates=0.1)
        energies = []
        for step in STEPS:
            states = run.go(60.0, step)[:: round(1.0 / step)]
            energies.append([run.energy(x) for x in states])
        swap = np.ptp([run.potential(x) for x in states])
        assert swap > 1.0
        assert np.ptp(energies[-1]) < 1e-5 * swap
        errors.append([np.ptp(energy) for energy in energies])
    assert order(errors) == pytest.approx(4.0, abs=0.5)


def test_momentum_is_lost_at_fourth_order_in_the_step(without_drag):
    """Without weight; linear and angular, in the world, with the fluid's, in a current."""
    errors = []
    for seed in SEEDS:
        run = FreeRun(changed(without_drag(seed), gravity=False), seed, current=(0.3, -0.2, 0.1))
        errors.append([])
        for step in STEPS:
            states = run.go(20.0, step)[:: round(0.2 / step)]
            momenta = np.array([run.momentum(x, 0.2 * k) for k, x in enumerate(states)])
            drift = np.linalg.norm((momenta - momenta[0]).reshape(-1, 2, 3), axis=2).max(axis=0)
            errors[-1].append(drift / np.linalg.norm(momenta[0].reshape(2, 3), axis=1))
    errors = np.array(errors)
    assert errors[:, -1].max() < 1e-9
    for kind in range(2):  # linear, angular
        assert order(errors[:, :, kind]) == pytest.approx(4.0, abs=0.1)


@pytest.mark.parametrize("current", [(0.0, 0.0, 0.0), (0.3, -0.2, 0.0)])
def test_weight_that_is_neutral_leaves_the_momentum_about_the_vertical(current):
    run = FreeRun(changed(REFERENCE, drag=False), seed=4, current=current)
    momenta = [run.momentum(x, 0.25 * k) for k, x in enumerate(run.go(10.0, 0.005)[::50])]
    for momentum in momenta:
        kept = [0, 1, 2, 5]
        bound = 1e-6 * np.linalg.norm(momenta[0])
        np.testing.assert_allclose(momentum[kept], momenta[0][kept], atol=bound)


def test_runge_kutta_is_of_fourth_order():
    run = FreeRun(changed(REFERENCE, drag=False), seed=5)
    exact = run.go(1.0, 0.00125)[-1]
    errors = [np.linalg.norm(run.go(1.0, step)[-1] - exact) for step in (0.04, 0.02, 0.01)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    np.testing.assert_allclose(orders, 4.0, atol=0.3)


def test_quaternion_stays_unit():
    states = FreeRun(REFERENCE, seed=6).go(20.0, 0.005)
    norms = np.linalg.norm(states[:, QUATERNION:VELOCITY], axis=1)
    np.testing.assert_allclose(norms, 1.0, atol=1e-14)
