"""The thrusters' lag against a fine integration."""

import numpy as np

from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix
from uvms_observer.disturbance.thrust_lag import ThrustLag

VEHICLE = load_vehicle()
DT = 0.05


def test_mean_wrench_of_an_interval_equals_the_integral_of_the_lag():
    rng, lag = np.random.default_rng(0), ThrustLag(VEHICLE)
    B = thruster_matrix(VEHICLE)
    tau = np.array([thruster.time_constant_s for thruster in VEHICLE.thrusters])
    assert np.ptp(tau) > 0.0  # the thrusters differ
    thrust = np.zeros(VEHICLE.n_thrusters)
    times = (np.arange(2000) + 0.5) * DT / 2000
    for _ in range(20):
        command = np.linalg.pinv(B) @ rng.standard_normal(6)
        course = command + np.exp(-times[:, None] / tau) * (thrust - command)
        thrust = command + np.exp(-DT / tau) * (thrust - command)
        np.testing.assert_allclose(lag.step(DT, B @ command), B @ course.mean(axis=0), atol=1e-6)


def test_a_constant_command_is_reached():
    lag, wrench = ThrustLag(VEHICLE), np.array([5.0, -4.0, 3.0, 0.5, -1.0, 2.0])
    assert np.linalg.norm(lag.step(DT, wrench)) < 0.3 * np.linalg.norm(wrench)
    for _ in range(100):
        mean = lag.step(DT, wrench)
    np.testing.assert_allclose(mean, wrench, atol=1e-9)
