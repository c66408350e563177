"""Fixes under water: what they are worth, in whatever frame they come, and only within range."""

from types import SimpleNamespace

import numpy as np
import pytest

from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import simulate
from uvms_core.errors import SignalError, VehicleFileError
from uvms_core.sensors import sensor_type
from uvms_core.sensors.position_fix import FixSample, from_message, to_message
from uvms_core.vehicle import load_vehicle
from uvms_core.world_frames import MAP_FRAME, R_MAP_MAP_NED

FIX = {"rate_hz": 2.0, "noise_m": 0.01, "position_m": [0.2, 0.0, 0.1]}
TOPIC = sensor_type("position_fix").topic


def position_errors(**section):
    """Distances (k,) m of the estimate from the truth in a hover of 40 s that began elsewhere."""
    overrides = {"sensors.position_fix": {**FIX, **section}} if section else {}
    scenario = load_scenario(
        "hover",
        ["navigation.initial_position_std_m=0.3", "plant.initial_position_m=[0.2, -0.1, 10.0]"],
        duration_s=40.0,
        seed=3,
    )
    vehicle = load_vehicle(overrides=overrides)
    scenario = scenario.for_vehicle(vehicle)
    scenario = scenario.model_copy(
        update={
            "navigation": scenario.navigation.model_copy(
                update={"initial_position_m": (0.0, 0.0, 10.0)}
            )
        }
    )
    rows = []

    def see(tick):
        if tick.odometry is not None:
            rows.append(np.linalg.norm(tick.odometry.position - tick.truth.odometry.position))

    simulate(scenario, vehicle, None, observe=see)
    return np.array(rows)


def test_with_fixes_the_estimate_finds_where_the_vehicle_is():
    without, far = position_errors(), position_errors(source_m=[50.0, 0.0, 10.0], max_range_m=5.0)
    found = position_errors(source_m=[2.0, 0.0, 10.0], max_range_m=5.0)
    assert without[-1] > 0.15
    np.testing.assert_array_equal(far, without)
    assert found[-200:].max() < 0.02


def message(sample, frame):
    plain = to_message(TOPIC, sample, ())
    position, covariance = sample.position, np.zeros((6, 6))
    covariance[:3, :3] = sample.covariance
    if frame == MAP_FRAME:
        position = R_MAP_MAP_NED @ position
        covariance[:3, :3] = R_MAP_MAP_NED @ sample.covariance @ R_MAP_MAP_NED.T
    point = SimpleNamespace(x=position[0], y=position[1], z=position[2])
    pose = SimpleNamespace(pose=SimpleNamespace(position=point), covariance=covariance.ravel())
    stamp = SimpleNamespace(**plain["header"]["stamp"])
    return SimpleNamespace(header=SimpleNamespace(stamp=stamp, frame_id=frame), pose=pose)


@pytest.mark.parametrize("frame", ["map_ned", MAP_FRAME])
def test_a_fix_is_the_same_in_either_frame(frame):
    spread = np.array([[0.04, 0.01, 0.0], [0.01, 0.09, 0.02], [0.0, 0.02, 0.16]])
    sample = FixSample(1_500_000_000, np.array([1.0, 2.0, 3.0]), spread)
    read = from_message(TOPIC, message(sample, frame), ())
    assert read.stamp == sample.stamp
    np.testing.assert_allclose(read.position, sample.position, atol=1e-12)
    np.testing.assert_allclose(read.covariance, sample.covariance, atol=1e-12)


def test_another_frame_is_refused_by_name():
    sample = FixSample(0, np.zeros(3), np.eye(3))
    with pytest.raises(SignalError, match="frame_id is 'odom'; it must be 'map_ned' or 'map'"):
        from_message(TOPIC, message(sample, "odom"), ())


def test_a_range_needs_something_that_it_counts_from():
    with pytest.raises(VehicleFileError, match="max_range_m needs source_m"):
        load_vehicle(overrides={"sensors.position_fix": {**FIX, "max_range_m": 5.0}})
