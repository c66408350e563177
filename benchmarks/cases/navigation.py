"""The navigation filter over 900 s of sensor samples, against real time."""

import time
from collections.abc import Iterator

import numpy as np
from metrics import Metric, Target

from uvms_core.signals import JointCommand, Odometry, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_observer import NavigationConfig, NavigationFilter

SECONDS, BATCH = 900.0, 200


def measure(full: bool) -> Iterator[Metric]:
    """All sensors at their rates while the vehicle drifts about; the plant's own time is left out.

    The factor is the median over batches of 10 s, since the machine's noise comes in bursts.
    """
    vehicle, config = load_vehicle(), PlantConfig()
    plant = Plant(vehicle, config, seed=1)
    navigation = NavigationFilter(vehicle, NavigationConfig())
    seconds, errors = [], []
    for _ in range(round(SECONDS / config.control_period_s)):
        frame = plant.sense()
        began = time.process_time()
        estimate = navigation.step(plant.stamp, frame.imu, frame.dvl, frame.pressure, frame.gps)
        seconds.append(time.process_time() - began)
        errors.append(estimate.position - plant.truth().odometry.position)
        thrust, effort = _push(plant.stamp, vehicle.n_thrusters, vehicle.n_joints)
        plant.step(ThrusterCommand(plant.stamp, thrust), JointCommand(plant.stamp, effort))
    batches = np.array(seconds[: len(seconds) // BATCH * BATCH]).reshape(-1, BATCH).sum(axis=1)
    factor = float(np.median(BATCH * config.control_period_s / batches))
    yield Metric(
        "navigation_filter", factor, "x real time", "real time; processor time of one core", factor,
        Target("value", ">=", 100.0),
    )  # fmt: skip
    yield from _drift(np.linalg.norm(errors, axis=1)[-1], estimate)


def _push(stamp: int, m: int, n: int):
    t = 1e-9 * stamp
    thrust = np.zeros(m)
    thrust[0] = 2.0 * np.sin(0.05 * t)  # back and forth
    return thrust, np.zeros(n)


def _drift(error: float, estimate: Odometry) -> Iterator[Metric]:
    """Submerged there is no fix: the position's error grows, as the filter itself predicts."""
    expected = float(np.sqrt(np.trace(estimate.pose_covariance[:3, :3])))
    yield Metric(
        "navigation_drift_900s", float(error), "m", "the filter's own standard deviation",
        float(error) / expected, Target("ratio", "<=", 3.0),
    )  # fmt: skip
