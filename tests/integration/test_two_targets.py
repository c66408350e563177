"""Two markers on the plant: one leaves the view, the other's place nobody told navigation."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics
from uvms_core.errors import ConfigError
from uvms_core.sensors import mounted_sensors
from uvms_core.vehicle import load_vehicle
from uvms_observer import NavigationFilter

CAMERA = {
    "type": "target_marker",
    "rate_hz": 5.0,
    "position_m": [0.9, -0.1, 0.15],
    "rpy_deg": [0.0, -90.0, 0.0],
    "field_of_view_deg": [70.0, 70.0],
    "max_range_m": 4.0,
    "latency_s": 0.1,
    "noise_m": 0.002,
    "angle_noise_deg": 1.0,
}
FIRST = {**CAMERA, "target_position_m": [0.9, -0.1, 11.65]}
SECOND = {**CAMERA, "target_position_m": [2.9, 0.3, 11.5], "target_rpy_deg": [180.0, 0.0, 30.0]}
SURVEYED = {"target_std_m": 0.002, "target_std_deg": 0.2}


def sailed(first, second):
    """The loop after 22 s, in which the vehicle went 2 m north from the first to the second."""
    vehicle = load_vehicle(
        overrides={
            "sensors.target_marker": first,
            "sensors.marker_ahead": second,
            "sensors.gps": None,
        }
    )
    words = [
        "navigation.initial_position_std_m=0.2",
        "navigation.initial_position_m=[-0.12, 0.15, 10.0]",
        "goal={pose: {position_m: [2.0, 0.0, 0.0], speed_max_m_s: 0.2}}",
    ]
    scenario = load_scenario("hover", words, duration_s=22.0, seed=4).for_vehicle(vehicle)
    loop = Loop(scenario, vehicle)
    goal, newest = scenario.build_goals(vehicle), {}
    while True:
        tick = loop.tick()
        for name in ("target_marker", "marker_ahead"):
            if samples := tick.sensors.samples[name]:
                newest[name] = samples[-1].stamp
        if tick.plan is not None and goal is not None:
            loop.planner.accept(goal)
            goal = None
        if tick.stamp >= 22_000_000_000:
            return loop, tick, newest
        loop.advance(tick)


def error_of(state, index, place):
    """Estimated place of a target minus the true one, and its std, (3,) m."""
    std = np.sqrt(np.diagonal(state.target_covariance)[6 * index :][:3])
    return state.target[7 * index :][:3] - place, std


def test_one_is_left_behind_and_the_other_found_where_it_is():
    """The first one is known in the map, and through it the vehicle and the second."""
    loop, tick, newest = sailed(FIRST | SURVEYED, SECOND)
    assert newest["target_marker"] < 14e9
    assert newest["marker_ahead"] > 21e9
    navigation = loop.parts[topics.NAVIGATION]
    assert navigation.trouble() is None
    assert navigation.status()["out_of_reach"] == "target_marker"
    state = navigation.filter.state
    found, std = error_of(state, 1, SECOND["target_position_m"])
    assert (np.abs(found) < 3.0 * std).all()
    assert std.max() < 0.03
    off = tick.odometry.position - tick.truth.odometry.position
    assert (np.abs(off) < 3.0 * np.sqrt(np.diagonal(tick.odometry.pose_covariance)[:3])).all()
    assert np.linalg.norm(off) < 0.03
    turned = Rotation.from_quat(state.target[10:14])
    true = Rotation.from_euler("ZYX", [30.0, 0.0, 180.0], degrees=True)
    assert (turned * true.inv()).magnitude() < np.radians(1.0)


def test_places_that_nobody_knows_are_right_relative_to_the_vehicle():
    """In the map all is off by where the vehicle began; between it and what it sees nothing is."""
    loop, tick, _ = sailed(FIRST, SECOND)
    state = loop.parts[topics.NAVIGATION].filter.state
    off = tick.odometry.position - tick.truth.odometry.position
    assert np.linalg.norm(off[:2]) > 0.1
    for index, section, most in ((0, FIRST, 0.03), (1, SECOND, 0.006)):
        found, std = error_of(state, index, section["target_position_m"])
        assert (np.abs(found) < 3.0 * std).all()
        assert np.linalg.norm(found - off) < most


def test_two_cameras_have_topics_and_frames_of_their_own():
    vehicle = load_vehicle(
        overrides={"sensors.target_marker": FIRST, "sensors.marker_ahead": SECOND}
    )
    found = [each.topic for each in mounted_sensors(vehicle) if "marker" in each.name]
    assert [(topic.name, topic.frame) for topic in found] == [
        ("sensors/target_marker", "target_marker_optical"),
        ("sensors/marker_ahead", "marker_ahead_optical"),
    ]


def test_more_targets_than_navigation_keeps_are_refused_by_number():
    added = {f"sensors.marker_{k}": FIRST for k in range(5)}
    with pytest.raises(ConfigError, match=r"has 5 sensors of type target_marker.*at most 4"):
        NavigationFilter(load_vehicle(overrides=added))
