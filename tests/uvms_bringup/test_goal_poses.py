"""The word `goal.pose`: its frames, what is refused, and a run in process."""

import json

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uvms_bringup.errors import ScenarioError
from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare

START = ["plant.initial_position_m=[1, 2, 8]", "plant.initial_rpy_deg=[0, 0, 40]"]


def built(*settings):
    scenario = load_scenario("hover", [*START, *settings])
    return scenario.goal.build(scenario.load_vehicle(), scenario.plant)


@pytest.mark.parametrize(
    ("word", "position", "yaw_deg"),
    [
        ("{position_m: [1, 0, 0.5]}", [2, 2, 8.5], 40),
        ("{yaw_deg: -30}", [1, 2, 8], 10),
        ("{hold_s: 5}", [1, 2, 8], 40),
        ("{frame: map_ned, position_m: [1, 0, 0.5]}", [1, 0, 0.5], 40),
        ("{frame: map_ned, position_m: [1, 0, 0.5], yaw_deg: 90}", [1, 0, 0.5], 90),
        ("{frame: map, position_m: [1, 0, -5], yaw_deg: 90}", [0, 1, 5], 0),
        ("{frame: map, yaw_deg: 0}", [1, 2, 8], 90),
    ],
)
def test_positions_and_headings_are_of_their_frame(word, position, yaw_deg):
    goal = built(f"goal.pose={word}")
    np.testing.assert_allclose(goal.position, position)
    yaw, pitch, roll = Rotation.from_quat(goal.quaternion).as_euler("ZYX", degrees=True)
    assert (yaw, pitch, roll) == pytest.approx((yaw_deg, 0.0, 0.0), abs=1e-9)


def test_times_and_speed_go_on_to_the_goal():
    goal = built("goal.pose={position_m: [1, 0, 0], duration_s: 20, hold_s: 5, speed_max_m_s: 0.2}")
    assert (goal.duration_s, goal.hold_s, goal.speed_max_m_s) == (20.0, 5.0, 0.2)
    assert load_scenario("hover", ["goal.pose={hold_s: 5, duration_s: 2}"]).goal.duration_s == 7.0


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("goal.pose={}", "a pose has position_m, yaw_deg or, to hold the start's, hold_s"),
        ("goal.pose={position_m: [1, 2]}", "goal.pose.position_m"),
        ("goal.pose={position_m: [1, 2, .nan]}", "goal.pose.position_m"),
        ("goal.pose={yaw_deg: 400}", "goal.pose.yaw_deg"),
        ("goal.pose={yaw_deg: 4, duration_s: 0}", "goal.pose.duration_s"),
        ("goal.pose={yaw_deg: 4, hold_s: -1}", "goal.pose.hold_s"),
        ("goal.pose={yaw_deg: 4, speed_max_m_s: 0}", "goal.pose.speed_max_m_s"),
        ("goal.pose={yaw_deg: 4, frame: odom}", "goal.pose.frame"),
        (
            "goal={pose: {yaw_deg: 4}, joints: {times_s: [9], positions_deg: [stowed]}}",
            "a goal has one of path, joints and pose; got joints and pose",
        ),
    ],
)
def test_what_is_no_pose_is_refused_by_name(setting, message):
    with pytest.raises(ScenarioError, match=message):
        load_scenario("hover", [setting])


def test_in_the_loop_the_vehicle_comes_there_and_stays():
    settings = ["goal.pose={position_m: [0.5, 0.2, -0.2], yaw_deg: 15, hold_s: 3}"]
    scenario = load_scenario("hover", settings, duration_s=18.0)
    vehicle = scenario.load_vehicle()
    loop, told = Loop(scenario, vehicle), []
    goal = scenario.goal.build(vehicle, scenario.plant)
    while loop.plant.stamp < 18e9:
        tick = loop.tick()
        if tick.plan is not None and tick.plan.finished is not None:
            told.append(tick.plan.finished)
        if tick.stamp == 0:
            loop.planner.accept(goal)
        loop.advance(tick)
    assert [result.success for result in told] == [True]
    assert np.linalg.norm(tick.truth.odometry.position - goal.position) < 0.05
    turned = Rotation.from_quat(tick.truth.odometry.quaternion).as_euler("ZYX", degrees=True)
    assert turned[0] == pytest.approx(15.0, abs=1.0)


def test_a_run_in_process_is_completed_and_its_log_says_so(tmp_path):
    settings = ["goal.pose={position_m: [0.2, 0, 0], duration_s: 8, hold_s: 2}"]
    scenario = load_scenario("hover", settings, duration_s=14.0)
    session = prepare(scenario, str(tmp_path / "run"), "as fast as possible", "test")
    summary = session.run_simulation()
    assert (summary["outcome"], summary["goal"]) == ("completed", "succeeded")
    kept = json.loads((tmp_path / "run" / "summary.json").read_text(encoding="utf-8"))
    assert kept["goal"] == "succeeded"
