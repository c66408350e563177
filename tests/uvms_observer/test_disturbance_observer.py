"""The disturbance observer against known accelerations, wrenches and identities."""

import numpy as np
import pytest
from small_plant import PERIOD, SmallPlant, run, steered

from uvms_core.signals import (
    JointCommand,
    JointStates,
    Odometry,
    ThrusterCommand,
    Wrench,
    to_nanoseconds,
)
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.loader import vehicle_from_data
from uvms_dynamics import (
    build_model,
    coupling_wrench,
    hull_bias_wrench,
    inverse_dynamics,
    mass_matrix,
    restoring_wrench,
    thruster_matrix,
)
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_observer import DisturbanceObserver, ObserverConfig

VEHICLE = load_vehicle()
MODEL = build_model(VEHICLE)
GOAL = np.radians([40.0, 30.0, 60.0, 20.0])
PUSH = np.array([3.0, -2.0, 4.0, 0.5, -1.0, 0.8])


def swinging(t, duration=10.0):
    """Angles, rates and accelerations (3, 4) of the uncontrolled run's joints: a quintic."""
    s = np.clip(t / duration, 0.0, 1.0)
    share = np.array([s**3 * (10 - 15 * s + 6 * s * s), 30 * s * s * (1 - s) ** 2 / duration])
    bend = 60 * s * (1 - s) * (1 - 2 * s) / duration**2
    way = np.radians([90.0, 0.0, -135.0, 0.0])
    start = np.radians([0.0, 0.0, 135.0, 0.0])
    return np.array([start + share[0] * way, share[1] * way, bend * way])


def swaying(t):
    """Velocity (6,) of a vehicle that sways a little, and its derivative."""
    w, a = np.array([0.5, 0.4, 0.6, 0.9, 0.7, 0.3]), np.array([0.1, 0.1, 0.1, 0.03, 0.03, 0.05])
    return a * np.sin(w * t), a * w * np.cos(w * t)


def signals(t, noise=None):
    """Odometry and joint states at t on these motions, with noise of navigation and encoders."""
    rng = noise or np.random.default_rng(0)
    scale = 0.0 if noise is None else 1.0
    q, q_dot, _ = swinging(t)
    sigma = np.repeat([3e-4, 9e-5], 3)
    nu = swaying(t)[0] + scale * sigma * rng.standard_normal(6)
    q = q + scale * np.radians(0.005) * rng.standard_normal(4)
    q_dot = q_dot + scale * np.radians(0.02) * rng.standard_normal(4)
    stamp, level = to_nanoseconds(t), np.array([0.0, 0.0, 0.0, 1.0])
    odometry = Odometry(stamp, np.zeros(3), level, nu, np.zeros((6, 6)), np.diag(sigma**2))
    return odometry, JointStates(stamp, q, q_dot, np.zeros(4))


def couplings(observer, noise=None):
    """Observed and true coupling at every tick of 12 s."""
    rows = []
    for t in np.arange(0.0, 12.0, PERIOD):
        budget, _ = observer.step(*signals(t, noise), None)
        true = coupling_wrench(MODEL, *swaying(t), *swinging(t))
        rows.append((budget.coupling, true))
    return np.array(rows[20:])


@pytest.mark.parametrize("seed", [None, 1, 2])
def test_coupling_follows_known_accelerations(seed):
    noise = None if seed is None else np.random.default_rng(seed)
    observed, true = np.moveaxis(
        couplings(DisturbanceObserver(VEHICLE, ObserverConfig()), noise), 1, 0
    )
    error = np.sqrt(np.mean((observed - true) ** 2, axis=0))
    assert np.linalg.norm(error[:3]) < 0.15 * np.linalg.norm(
        np.sqrt(np.mean(true[:, :3] ** 2, axis=0))
    )
    assert np.linalg.norm(error[3:]) < 0.15 * np.linalg.norm(
        np.sqrt(np.mean(true[:, 3:] ** 2, axis=0))
    )


def test_budget_and_total_are_made_of_their_parts():
    plant = SmallPlant(VEHICLE, PUSH)
    budget, total = run(plant, DisturbanceObserver(VEHICLE, ObserverConfig()), 5.0, GOAL)[-1]
    fresh = SmallPlant(VEHICLE, PUSH)
    without = run(fresh, DisturbanceObserver(VEHICLE, ObserverConfig(external=False)), 5.0, GOAL)
    np.testing.assert_allclose(total.wrench - without[-1][1].wrench, budget.external, atol=1e-12)
    np.testing.assert_array_equal(without[-1][0].external, budget.external)
    assert np.linalg.norm(budget.external) > 1.0


def test_the_total_leaves_the_vehicles_own_inertia_to_the_controller():
    """M nu_dot + hull bias - total is the inverse dynamics: every wrench counts once."""
    observer = DisturbanceObserver(VEHICLE, ObserverConfig(external=False))
    level = np.array([0.0, 0.0, 0.0, 1.0])
    q, q_dot, q_ddot = np.array([0.5, 0.3, 0.8, 0.1]), np.array([0.1, -0.2, 0.1, 0.3]), np.zeros(4)
    nu, nu_dot = swaying(3.0)
    odometry = Odometry(0, np.zeros(3), level, nu, np.zeros((6, 6)), np.zeros((6, 6)))
    _, total = observer.step(odometry, JointStates(0, q, q_dot, np.zeros(4)), None)
    asked = inverse_dynamics(MODEL, level, nu, nu_dot, q, q_dot, q_ddot)[:6]
    inertia = mass_matrix(MODEL, q)[:6, :6] @ nu_dot + hull_bias_wrench(MODEL, nu)
    np.testing.assert_allclose(inertia - total.wrench, asked, atol=1e-9)


def test_restoring_wrench_is_that_of_the_estimated_attitude_and_joints():
    observer = DisturbanceObserver(VEHICLE, ObserverConfig())
    odometry, joints = signals(5.0)
    budget, _ = observer.step(odometry, joints, None)
    expected = restoring_wrench(MODEL, odometry.quaternion, joints.position)
    np.testing.assert_array_equal(budget.restoring, expected)


def test_a_constant_push_is_found_while_the_arm_moves():
    plant = SmallPlant(VEHICLE, PUSH)
    results = run(plant, DisturbanceObserver(VEHICLE, ObserverConfig()), 20.0, GOAL)
    np.testing.assert_allclose(results[-1][0].external, PUSH, rtol=1e-3)


@pytest.mark.parametrize("bandwidth", [0.3, 1.0])
def test_the_external_wrench_follows_with_the_stated_bandwidth(bandwidth):
    config = ObserverConfig(external_bandwidth_rad_s=bandwidth)
    results = run(SmallPlant(VEHICLE, PUSH), DisturbanceObserver(VEHICLE, config), 3.0, GOAL)
    for tick in (10, 30, 59):
        share = -np.expm1(-bandwidth * tick * PERIOD)
        np.testing.assert_allclose(results[tick][0].external, share * PUSH, atol=0.01)


def test_nothing_is_external_where_the_model_explains_everything():
    results = run(SmallPlant(VEHICLE), DisturbanceObserver(VEHICLE, ObserverConfig()), 10.0, GOAL)
    assert max(np.abs(budget.external).max() for budget, _ in results) < 2e-3
    assert max(np.abs(budget.coupling).max() for budget, _ in results) > 1.0


def test_a_current_is_external():
    """At rest over ground: thrusters, weight, buoyancy and the current's pull balance."""
    plant = SmallPlant(VEHICLE, current=(-0.08, 0.06, 0.0))
    budget, _ = run(plant, DisturbanceObserver(VEHICLE, ObserverConfig()), 60.0)[-1]
    thrust = steered(plant)[2].wrench
    balance = thrust + budget.restoring + budget.coupling + budget.external
    assert np.linalg.norm(budget.external[:3]) > 1.0
    np.testing.assert_allclose(balance, 0.0, atol=0.02)


def test_a_payload_that_the_model_does_not_know_is_external():
    overrides = {"hull.mass_kg": VEHICLE.hull.mass_kg, "hull.cg_m": VEHICLE.hull.cg_m}
    overrides["arm.links.3.mass_kg"] = VEHICLE.arm.links[3].mass_kg + 5.0 / 9.81
    loaded = load_vehicle(overrides=overrides)
    plant = SmallPlant(loaded)
    budget, _ = run(plant, DisturbanceObserver(VEHICLE, ObserverConfig()), 40.0, GOAL)[-1]
    weight = restoring_wrench(plant.model, plant.x[3:7], plant.x[13:17]) - budget.restoring
    assert np.linalg.norm(weight[:3]) == pytest.approx(5.0, rel=1e-6)
    np.testing.assert_allclose(budget.external, weight, atol=0.02)


def test_without_the_achieved_wrench_the_external_part_is_kept():
    plant, observer = SmallPlant(VEHICLE, PUSH), DisturbanceObserver(VEHICLE, ObserverConfig())
    kept = run(plant, observer, 5.0, GOAL)[-1][0].external
    budget, _ = observer.step(plant.odometry(), plant.joints(), None)
    np.testing.assert_array_equal(budget.external, kept)


def test_the_sign_of_a_quaternion_does_not_matter():
    flipped = SmallPlant(VEHICLE, PUSH)
    original = flipped.odometry

    def odometry():
        sample = original()
        sign = -1.0 if flipped.tick % 2 else 1.0
        return Odometry(*[sign * v if k == 2 else v for k, v in enumerate(vars(sample).values())])

    flipped.odometry = odometry
    first = run(flipped, DisturbanceObserver(VEHICLE, ObserverConfig()), 3.0)[-1]
    second = run(SmallPlant(VEHICLE, PUSH), DisturbanceObserver(VEHICLE, ObserverConfig()), 3.0)[-1]
    np.testing.assert_allclose(first[0].external, second[0].external, atol=1e-12)


@pytest.mark.parametrize("joints", [1, 2, 3])
def test_arms_of_other_lengths(joints):
    data = VEHICLE.model_dump()
    data["arm"]["joints"] = data["arm"]["joints"][:joints]
    data["arm"]["links"] = data["arm"]["links"][:joints]
    data["arm"]["stowed_deg"] = data["arm"]["stowed_deg"][:joints]
    data["arm"]["postures_deg"] = {}
    vehicle = vehicle_from_data(data)
    plant = SmallPlant(vehicle, PUSH)
    results = run(plant, DisturbanceObserver(vehicle, ObserverConfig()), 15.0, GOAL[:joints])
    np.testing.assert_allclose(results[-1][0].external, PUSH, rtol=5e-3)


def test_the_same_signals_give_the_same_wrenches():
    first, second = (
        run(SmallPlant(VEHICLE, PUSH), DisturbanceObserver(VEHICLE, ObserverConfig()), 3.0, GOAL)[
            -1
        ]
        for _ in range(2)
    )
    np.testing.assert_array_equal(first[1].wrench, second[1].wrench)


def test_it_agrees_with_the_plant():
    """True state in, against the plant's own budget: the plant is another implementation."""
    plant = Plant(VEHICLE, PlantConfig(), seed=1)
    observer = DisturbanceObserver(VEHICLE, ObserverConfig())
    thrust = np.array([4.0, 1.0, -1.0, 0.5, 0.4, -0.4, -0.6])
    effort, achieved, errors = np.array([2.0, -3.0, 1.0, 0.1]), None, []
    for _ in range(100):
        truth = plant.truth()
        budget, _ = observer.step(truth.odometry, truth.joints, achieved)
        errors.append(np.r_[budget.restoring - truth.disturbance.restoring, budget.external])
        plant.step(ThrusterCommand(plant.stamp, thrust), JointCommand(plant.stamp, effort))
        achieved = Wrench(plant.stamp, thruster_matrix(VEHICLE) @ thrust)
    assert np.abs(np.array(errors)[:, :6]).max() < 1e-12
    assert np.abs(np.array(errors)[:, 6:]).max() < 0.02
