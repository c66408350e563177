"""Scenarios with events, and with a plant that differs from the model."""

import pytest

from uvms_bringup.errors import ScenarioError
from uvms_bringup.scenario import Scenario, load_scenario


def test_a_scenario_with_events_is_the_same_again():
    events = (
        "events=[{at_s: 1.0, sensor: dvl, fault: bias, bias: 0.1}, {at_s: 2.0, payload: release},"
        " {at_s: 1.0, payload: {mass_kg: 1.0, volume_m3: 0.0}}, {at_s: 3.0, wrench: {}},"
        " {at_s: 3.0, joint: elbow, stuck: true}, {at_s: 3.0, thruster: main, stuck_at_n: 3.0}]"
    )
    scenario = load_scenario("hover", [events, "plant.mismatch.mass=0.1"])
    assert Scenario.model_validate(scenario.model_dump(mode="json")) == scenario


def test_a_setting_reaches_the_plants_own_vehicle_and_single_events():
    settings = (
        "plant.vehicle_overrides.hull.cb_m=[0.0, 0.0024, 0.0]",
        "events.0.payload.mass_kg=2.0",
        "events.1.at_s=50.0",
    )
    scenario = load_scenario("grasp", settings)
    assert scenario.plant.vehicle_overrides == {"hull.cb_m": [0.0, 0.0024, 0.0]}
    assert scenario.events[0].payload.mass_kg == 2.0
    assert scenario.events[1].at_s == 50.0
    with pytest.raises(ScenarioError, match="'2' is no item of the list; one of 0 to 1"):
        load_scenario("grasp", ["events.2.at_s=50.0"])


@pytest.mark.parametrize(
    ("setting", "words"),
    [
        ("events=[{at_s: 1.0, thruster: mian, effectiveness: 0.0}]", "events.0: thruster 'mian'"),
        ("plant.vehicle_overrides.hull.masskg=1", "plant.vehicle_overrides: .* no 'masskg'"),
        ("plant.mismatch.buoyancy_centre_m=1.0", "plant.mismatch: .*hull.cb_m"),
    ],
)
def test_what_the_plant_cannot_be_is_refused_before_anything_starts(setting, words):
    with pytest.raises(ScenarioError, match=words):
        load_scenario("hover", [setting]).load_vehicle()


def test_waves_and_seabed_have_one_depth():
    settings = [
        "plant.current.waves=[{height_m: 0.8, period_s: 5.0, water_depth_m: 20.0}]",
        "vehicle.environment.seabed_depth_m=50.0",
    ]
    words = r"plant.current.waves.0.water_depth_m: 20 m, but .*environment.seabed_depth_m is 50 m"
    with pytest.raises(ScenarioError, match=words):
        load_scenario("hover", settings).load_vehicle()
    settings[1] = "vehicle.environment.seabed_depth_m=20.0"
    load_scenario("hover", settings).load_vehicle()


def test_waves_shorter_than_twice_the_hull_are_refused():
    """A wave of 1.7 s is 4.51 m long in deep water, g T^2 / 2 pi, and the hull 2.4 m."""
    wave = "plant.current.waves=[{{height_m: 0.1, period_s: {}, water_depth_m: 50.0}}]"
    words = r"waves.0.period_s: a wave of 1.7 s is 4.51 m long, less than 2 times the hull's 2.4 m"
    with pytest.raises(ScenarioError, match=words):
        load_scenario("hover", [wave.format(1.7)]).load_vehicle()
    load_scenario("hover", [wave.format(1.8)]).load_vehicle()
