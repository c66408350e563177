"""Obstacles of a scenario: what is refused with which words, and who knows of them."""

import pytest

from uvms_bringup.errors import ScenarioError
from uvms_bringup.ros.parameter_file import config_of
from uvms_bringup.scenario import Scenario, load_scenario
from uvms_core import topics
from uvms_core.ros.parameters import flatten

WALL = "{name: wall, box: {center_m: [5.0, 0.0, 10.0], size_m: [1.0, 4.0, 4.0]}}"


def refusal(*settings):
    with pytest.raises(ScenarioError) as fault:
        load_scenario("hover", settings).load_vehicle()
    return str(fault.value)


@pytest.mark.parametrize(
    ("obstacles", "words"),
    [
        ("[{name: rock}]", "'rock' is one of sphere, box; this one has neither"),
        (
            "[{name: it, sphere: {center_m: [0, 0, 0], radius_m: 1},"
            " box: {center_m: [0, 0, 0], size_m: [1, 1, 1]}}]",
            "this one has sphere and box",
        ),
        (
            "[{name: seabed, sphere: {center_m: [0, 0, 0], radius_m: 1}}]",
            "environment.seabed_depth_m",
        ),
        (
            "[{name: it, sphere: {center_m: [0, 0, 0], radius_m: 0}}]",
            "radius_m: Input should be greater",
        ),
        ("[{name: it, box: {center_m: [0, 0, 0], size_m: [1, -2, 1]}}]", "(got -2)"),
        (f"[{WALL}, {WALL}]", "used more than once: wall"),
    ],
)
def test_what_is_no_obstacle_is_refused(obstacles, words):
    assert words in refusal(f"obstacles={obstacles}")


def test_a_start_in_an_obstacle_is_refused_with_pair_and_depth():
    """The stern thruster's end of the hull is at -1.2 m: a ball of 0.5 m about -1.5 m has it in."""
    rock = "{name: rock, sphere: {center_m: [-1.5, 0.0, 10.0], radius_m: 0.5}}"
    assert "starts with hull in rock, by 0.200 m" in refusal(f"obstacles=[{rock}]")


def test_a_start_in_the_seabed_is_refused():
    """The stowed gripper is the lowest."""
    words = refusal("vehicle.environment.seabed_depth_m=10.4")
    assert "starts with gripper in seabed" in words
    load_scenario("hover", ["vehicle.environment.seabed_depth_m=12"]).load_vehicle()


def test_where_it_starts_counts_and_how_it_is_turned():
    """Turned by 90 degrees the bow is 1.2 m east."""
    rock = "obstacles=[{name: rock, sphere: {center_m: [3.0, 5.3, 10.0], radius_m: 0.2}}]"
    start = "plant.initial_position_m=[3.0, 4.0, 10.0]"
    load_scenario("hover", [rock, start]).load_vehicle()
    words = refusal(rock, start, "plant.initial_rpy_deg=[0, 0, 90]")
    assert "in rock" in words


def test_the_planner_knows_the_obstacles_of_the_scenario():
    scenario = load_scenario("hover", [f"obstacles=[{WALL}]"])
    assert scenario.planner.obstacles == scenario.obstacles
    parameters = flatten(config_of(scenario, topics.MOTION_PLANNER))
    assert "wall" in parameters["obstacles"]
    assert Scenario.model_validate(scenario.model_dump(mode="json")) == scenario


def test_or_what_it_is_told():
    scenario = load_scenario("hover", [f"obstacles=[{WALL}]", "planner.obstacles=[]"])
    assert (len(scenario.obstacles), scenario.planner.obstacles) == (1, ())
