"""Bandwidth by rule and stated confidence of the external wrench, against noise and bounds."""

import numpy as np
import pytest
from small_plant import PERIOD, SmallPlant, run, steered

from uvms_core.vehicle import load_vehicle
from uvms_dynamics.external_bandwidth import NOISE_SHARE, PHASE_RAD, thrust_authority
from uvms_dynamics.joint_prediction import loop_delay
from uvms_observer import (
    CombinedObserver,
    DisturbanceObserver,
    ModelObserver,
    ObserverConfig,
    external_bandwidth,
)
from uvms_observer.disturbance.none import NoObserver
from uvms_observer.disturbance.observer import FormerObserver

VEHICLE = load_vehicle()
PUSH = np.array([3.0, -2.0, 4.0, 0.5, -1.0, 0.8])
SIGMA = np.repeat([3e-4, 9e-5], 3)


def noisier(factor):
    dvl, imu = VEHICLE.sensors.dvl, VEHICLE.sensors.imu
    return load_vehicle(
        overrides={
            "sensors.dvl.noise_m_s": factor * dvl.noise_m_s,
            "sensors.imu.gyro_noise_deg_s": factor * imu.gyro_noise_deg_s,
        }
    )


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5", "reference_auv_light"])
def test_the_delay_bounds_the_bandwidth(name):
    vehicle = load_vehicle(name)
    bandwidth = external_bandwidth(vehicle, PERIOD)
    assert (bandwidth > 0.0).all()
    assert (bandwidth <= PHASE_RAD / loop_delay(vehicle, PERIOD) * (1 + 1e-12)).all()


def test_noise_bounds_it_too():
    noisy = external_bandwidth(noisier(1000.0), PERIOD)
    noisier_still = external_bandwidth(noisier(4000.0), PERIOD)
    assert (noisy < external_bandwidth(VEHICLE, PERIOD)).all()
    assert (noisier_still < noisy).all()
    assert (thrust_authority(VEHICLE) > 0.0).all()
    assert 0.0 < NOISE_SHARE < 0.1


def test_the_estimate_is_as_noisy_as_it_says():
    """Held still, with white noise of the velocity: std over time against the stated one."""
    rng, plant = np.random.default_rng(4), SmallPlant(VEHICLE)
    observer, achieved, found = DisturbanceObserver(VEHICLE, ObserverConfig()), None, []
    for _ in range(800):
        odometry = plant.odometry()
        odometry.nu[:] += SIGMA * rng.standard_normal(6)
        odometry.twist_covariance[:] = np.diag(SIGMA**2)
        budget, _ = observer.step(odometry, plant.joints(), achieved)
        found.append(budget.external)
        thrust, effort, achieved = steered(plant)
        plant.step(thrust, effort)
    ratio = np.std(found[200:], axis=0) / budget.external_sigma
    np.testing.assert_allclose(ratio, 1.0, atol=0.25)


def test_a_given_bandwidth_comes_before_the_rule_and_the_former_name_has_its_own():
    config = ObserverConfig(external_bandwidth_rad_s=1.1)
    with pytest.warns(DeprecationWarning, match="is now called momentum"):
        former = FormerObserver(VEHICLE, ObserverConfig())
    for observer, K in (
        (DisturbanceObserver(VEHICLE, config), 1.1),
        (former, 0.5),
        (DisturbanceObserver(VEHICLE, ObserverConfig()), external_bandwidth(VEHICLE, PERIOD)),
    ):
        found = run(SmallPlant(VEHICLE, PUSH), observer, 1.05)[-1][0].external
        np.testing.assert_allclose(found, -np.expm1(-K) * PUSH, atol=0.02)


def test_what_each_observer_says():
    """none: nothing; paper: the model alone; momentum and combined: what is left as well."""
    budgets = {
        cls: run(SmallPlant(VEHICLE, PUSH), cls(VEHICLE, ObserverConfig()), 3.0)[-1]
        for cls in (NoObserver, ModelObserver, DisturbanceObserver, CombinedObserver)
    }
    assert not budgets[NoObserver][1].wrench.any()
    paper, total = budgets[ModelObserver]
    assert not paper.external.any()
    assert not paper.external_sigma.any()
    assert total.wrench.any()
    momentum, combined = budgets[DisturbanceObserver][0], budgets[CombinedObserver][0]
    np.testing.assert_array_equal(momentum.external, combined.external)
    np.testing.assert_array_equal(momentum.restoring, paper.restoring)
    assert momentum.payload is None
    assert combined.payload.held is False
