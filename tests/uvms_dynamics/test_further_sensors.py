"""Models of compass, magnetometer, depth gauge and DVL in water lock: statistics and places."""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_core.rotations import quat_to_rpy
from uvms_core.signals import WATER_LOCK
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation.sensors import SensorSuite, Trajectory
from uvms_dynamics.simulation.sensors.depth import DepthSensor
from uvms_dynamics.simulation.sensors.dvl import DvlSensor
from uvms_dynamics.simulation.sensors.heading import HeadingSensor
from uvms_dynamics.simulation.sensors.magnetometer import MagnetometerSensor

PERIOD = 10_000_000  # ns
PLACE = {"rate_hz": 100.0, "position_m": [0.5, 0.0, 0.2]}
EARTH = np.array([17.0, 3.0, 45.0])
VEHICLE = load_vehicle(
    overrides={
        "environment.magnetic_field_ut": EARTH.tolist(),
        "sensors.heading": {**PLACE, "noise_deg": 2.0},
        "sensors.magnetometer": {**PLACE, "noise_ut": 0.5},
        "sensors.depth": {**PLACE, "noise_m": 0.05},
        "sensors.dvl_aft": {**PLACE, "type": "dvl", "noise_m_s": 0.01, "scale_error": 0.0},
    }
)
TILT = Rotation.from_euler("ZYX", [120.0, 15.0, -10.0], degrees=True)


def still(count=4000, current=(0.0, 0.0, 0.0)):
    """At rest in the water, tilted, at a depth of 10 m."""
    state = np.zeros(13)
    state[2], state[3:7] = 10.0, TILT.as_quat()
    stamps = tuple(range(PERIOD, (count + 1) * PERIOD, PERIOD))
    return Trajectory(stamps, np.tile(state, (count, 1)), np.zeros((count, 13)), np.array(current))


def test_a_compass_errs_in_the_heading_alone():
    samples = HeadingSensor(VEHICLE, VEHICLE.sensors.mounted["heading"], PERIOD, 1).sample(still())
    angles = np.degrees([quat_to_rpy(sample.quaternion) for sample in samples])
    np.testing.assert_allclose(angles[:, :2].T, [[-10.0] * 4000, [15.0] * 4000], atol=1e-9)
    assert abs(angles[:, 2].mean() - 120.0) < 4.0 * 2.0 / np.sqrt(4000)
    np.testing.assert_allclose(angles[:, 2].std(), 2.0, rtol=0.05)


def test_a_magnetometer_sees_the_field_of_the_earth_in_its_axes():
    section = VEHICLE.sensors.mounted["magnetometer"]
    samples = MagnetometerSensor(VEHICLE, section, PERIOD, 1).sample(still())
    fields = 1e6 * np.array([sample.field for sample in samples])
    limit = 4.0 * 0.5 / np.sqrt(4000)
    np.testing.assert_allclose(fields.mean(axis=0), TILT.inv().apply(EARTH), atol=limit)
    np.testing.assert_allclose(fields.std(axis=0), 0.5, rtol=0.05)


def test_a_depth_gauge_reads_its_own_depth():
    samples = DepthSensor(VEHICLE, VEHICLE.sensors.mounted["depth"], PERIOD, 1).sample(still())
    depths = np.array([sample.depth for sample in samples])
    expected = 10.0 + TILT.apply(PLACE["position_m"])[2]
    assert abs(depths.mean() - expected) < 4.0 * 0.05 / np.sqrt(4000)
    np.testing.assert_allclose(depths.std(), 0.05, rtol=0.05)


def test_in_water_lock_the_current_is_not_seen():
    drifting = still(current=(0.3, -0.1, 0.0))
    section = VEHICLE.sensors.mounted["dvl_aft"]
    for lock, expected in (("bottom", TILT.inv().apply([0.3, -0.1, 0.0])), (WATER_LOCK, 0.0)):
        own = section.model_copy(update={"lock": lock})
        samples = DvlSensor(VEHICLE, own, PERIOD, 1).sample(drifting)
        assert {sample.lock for sample in samples} == {lock}
        mean = np.mean([sample.velocity for sample in samples], axis=0)
        np.testing.assert_allclose(mean, np.broadcast_to(expected, 3), atol=1e-3)


def test_two_of_a_kind_err_apart_and_the_first_as_without_the_second():
    both = load_vehicle(
        overrides={"sensors.dvl_aft": {**dump(), "type": "dvl", "position_m": [-0.3, 0.0, 0.17]}}
    )
    frames = []
    for vehicle in (load_vehicle(), both):
        suite = SensorSuite(vehicle, 3, lambda period, name: None)
        trajectory = replace(still(200), stamps=tuple(range(0, 200 * PERIOD, PERIOD)))
        frames.append(suite.sample(trajectory, np.zeros(4), np.zeros(4), np.zeros(4)))
    alone, first = (np.array([each.velocity for each in frame.dvl]) for frame in frames)
    second = np.array([each.velocity for each in frames[1].samples["dvl_aft"]])
    np.testing.assert_array_equal(alone, first)
    assert (first != second).all()


def dump():
    return load_vehicle().sensors.dvl.model_dump(exclude_unset=True)
