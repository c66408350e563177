"""Filter and observer on the plant's own sensors: another implementation of every model."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from uvms_core.signals import JointCommand, ThrusterCommand, Wrench
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_observer import DisturbanceObserver, NavigationConfig, NavigationFilter, ObserverConfig

VEHICLE = load_vehicle()
B = thruster_matrix(VEHICLE)
RUNS, SECONDS = 14, 15.0
START = (0.0, 0.0, 10.0)


def drive(plant):
    """Slow swimming with turns, the arm held by the shoulder's torque alone."""
    t = plant.stamp * 1e-9
    side, turn = 3.0 * np.sin(0.5 * t), 2.0 * np.sin(0.3 * t)
    thrust = np.array([4.0, side + turn, side - turn, *(0.5 * np.sin([t, t + 1, t + 2, t + 3]))])
    return thrust, np.array([0.3 * np.sin(0.8 * t), -3.0, 3.0, 0.0])


def run(seed):
    """Truth, odometry and budgets of a run whose start is as uncertain as configured."""
    config = PlantConfig(initial_position_m=START, initial_rpy_deg=(2.0, -3.0, 40.0))
    plant = Plant(VEHICLE, config, seed)
    offset = 0.01 * np.random.default_rng([seed, 7]).standard_normal(3)
    guess = tuple(float(x) for x in START + offset)
    navigation = NavigationFilter(VEHICLE, NavigationConfig(initial_position_m=guess))
    observer = DisturbanceObserver(VEHICLE, ObserverConfig())
    achieved, budgets = None, []
    for _ in range(round(SECONDS / 0.05)):
        frame, truth = plant.sense(), plant.truth()
        samples = (frame.imu, frame.dvl, frame.pressure, frame.gps)
        odometry = navigation.step(plant.stamp, *samples)
        budget, _ = observer.step(odometry, frame.joints, achieved)
        budgets.append((budget, truth.disturbance))
        thrust, effort = drive(plant)
        achieved = Wrench(plant.stamp, B @ thrust)
        plant.step(ThrusterCommand(plant.stamp, thrust), JointCommand(plant.stamp, effort))
    return truth.odometry, odometry, budgets


@pytest.fixture(scope="module")
def runs():
    return [run(seed) for seed in range(RUNS)]


def assert_consistent(errors, covariances):
    total = sum(e @ np.linalg.solve(P, e) for e, P in zip(errors, covariances, strict=True))
    low, high = chi2.ppf([0.0005, 0.9995], 6 * len(errors))
    assert low < total < high


def test_pose_errors_are_as_large_as_their_covariance_says(runs):
    errors = []
    for truth, odometry, _ in runs:
        turn = Rotation.from_quat(truth.quaternion) * Rotation.from_quat(odometry.quaternion).inv()
        errors.append(np.concatenate((truth.position - odometry.position, turn.as_rotvec())))
    assert_consistent(errors, [odometry.pose_covariance for _, odometry, _ in runs])


def test_twist_errors_are_as_large_as_their_covariance_says(runs):
    errors = [truth.nu - odometry.nu for truth, odometry, _ in runs]
    assert np.linalg.norm([truth.nu for truth, _, _ in runs]) > 0.5  # the vehicle moves
    assert_consistent(errors, [odometry.twist_covariance for _, odometry, _ in runs])


def test_the_budget_follows_the_plants(runs):
    for _, _, budgets in runs:
        for budget, truth in budgets[20:]:
            np.testing.assert_allclose(budget.restoring, truth.restoring, atol=0.03)
            error = np.abs(budget.external - truth.external)
            assert (error < 5.0 * budget.external_sigma + 0.05).all()
    errors = [b.coupling - t.coupling for _, _, budgets in runs for b, t in budgets[20:]]
    sizes = [t.coupling for _, _, budgets in runs for _, t in budgets[20:]]
    assert np.linalg.norm(errors) < 0.3 * np.linalg.norm(sizes)
