"""The mission from the surface to the work object, shortened, and what its summary says of it."""

from itertools import pairwise

import pytest

from uvms_bringup.campaign.single import summary_of
from uvms_bringup.errors import ScenarioError
from uvms_bringup.scenario import load_scenario

DEEP, NORTH = 1.5, 2.0
AT = "vehicle.sensors.target_marker"
SHORTER = {
    "duration_s": 52.0,
    f"{AT}.target_position_m": [NORTH + 0.95, -0.15, DEEP + 1.65],
    "goals.0.pose.hold_s": 2.0,
    "goals.1.pose.position_m": [0.0, 0.0, DEEP],
    "goals.2.pose.position_m": [NORTH, 0.0, DEEP],
    "goals.2.pose.hold_s": 2.0,
    "goals.3.path.phases": [{"duration_s": 6.0, "to_m": [0.0, 0.0, 0.03]}],
    "events": [{"at_s": 12.0, "until_s": 17.0, "sensor": "dvl", "fault": "silent"}],
}


@pytest.fixture(scope="module")
def summary():
    return summary_of(load_scenario("dive_and_work", values=SHORTER))


def test_every_goal_of_the_mission_is_reached_in_turn(summary):
    assert (summary["outcome"], summary["goal"]) == ("completed", "succeeded"), summary["reasons"]
    goals = summary["goals"]
    assert [goal["kind"] for goal in goals] == ["pose", "pose", "pose", "path"]
    assert {goal["state"] for goal in goals} == {"succeeded"}
    for before, after in pairwise(goals):
        assert after["began_s"] == before["ended_s"]


def test_the_tool_is_where_it_should_be_at_the_marker(summary):
    work = summary["goals"][-1]
    assert work["end_effector_error_m"]["rms"] < 0.01
    assert work["end_effector_error_m"]["max"] < 0.02
    assert summary["end_effector_error_m"]["max"] == work["end_effector_error_m"]["max"]


def test_navigation_gets_better_with_the_marker_and_says_so(summary):
    surface, *_, work = summary["goals"]
    assert work["navigation_std_m"]["end"] < 0.6 * surface["navigation_std_m"]["end"]
    for goal in summary["goals"]:
        assert goal["navigation_error_m"]["end"] < 4.0 * goal["navigation_std_m"]["end"]


def test_a_scenario_has_one_goal_or_several():
    with pytest.raises(ScenarioError, match="a scenario has either goal or goals"):
        load_scenario("dive_and_work", ["goal={pose: {hold_s: 1.0}}"])
    with pytest.raises(ScenarioError, match=r"goals\.0: has none of path, joints and pose"):
        load_scenario("dive_and_work", ["goals=[{}]"])


def test_a_goal_begins_where_the_one_before_it_leads():
    scenario = load_scenario("dive_and_work")
    vehicle = scenario.load_vehicle()
    *_, there, work = scenario.for_vehicle(vehicle).build_goals(vehicle)
    tool = work.positions[0] - there.position
    assert abs(tool[0] - 1.112) < 1e-3  # the tool ahead of the origin, arm as at the start
    assert work.positions[0][2] == pytest.approx(20.739, abs=1e-3)
