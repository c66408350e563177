"""`uvms tune`: the gains that a run takes, and what is said of them."""

import json

import pytest

from uvms_bringup.cli import main
from uvms_bringup.scenario import load_scenario
from uvms_control.design.gains import vehicle_gains


def printed(capsys, *arguments):
    assert main(["tune", *arguments]) == 0
    return capsys.readouterr().out


def test_every_axis_is_there_with_its_margins(capsys):
    found = json.loads(printed(capsys, "reference_auv", "--json"))
    assert list(found["axes"]) == ["surge", "sway", "heave", "roll", "pitch", "yaw"]
    assert found["left_to_the_hull"] == []
    for axis in found["axes"].values():
        assert axis["delay_margin_s"] >= 2.0 * found["control_period_s"]
        assert axis["gain_margin"] >= 2.0
        assert axis["noise_share"] <= 0.05
        share = axis["inertia"] * axis["stiffness_1_s2"] / axis["authority"]
        assert axis["authority_share_at_unit_error"] == pytest.approx(share)
        assert axis["bandwidth_rad_s"] ** 2 == pytest.approx(axis["stiffness_1_s2"])


def test_a_run_takes_these_gains(capsys):
    found = json.loads(printed(capsys, "reference_auv", "--control-period", "0.1", "--json"))
    scenario = load_scenario("hover", ["plant.control_period_s=0.1"])
    gains = vehicle_gains(scenario.load_vehicle(), 0.1, scenario.control.gains)
    stiffness = [axis["stiffness_1_s2"] for axis in found["axes"].values()]
    assert gains.stiffness == pytest.approx(stiffness)


def test_an_axis_without_authority_is_named(capsys):
    text = printed(capsys, "bluerov2_alpha5", "--posture", "stowed")
    assert "pitch left to the hull" in text
    assert "arm stowed" in text.splitlines()[0]
    assert len(text.splitlines()) == 8
    assert max(map(len, text.splitlines())) <= 180


def test_slower_thrusters_get_less(capsys):
    slow = [f"thrusters.{k}.time_constant_s=0.4" for k in range(7)]
    settings = [word for setting in slow for word in ("--set", setting)]
    common = ("reference_auv", "--json", "--set", "control.gains.lag_compensation=0")
    first = json.loads(printed(capsys, *common))["axes"]
    then = json.loads(printed(capsys, *common, *settings))["axes"]
    for name, axis in then.items():
        assert axis["thruster_lag_s"] == 0.4
        assert axis["bandwidth_rad_s"] < 0.7 * first[name]["bandwidth_rad_s"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nobody"], "nobody"),
        (["reference_auv", "--posture", "curled"], "has no posture 'curled'; choose one of stowed"),
        (["reference_auv", "--set", "hull.mass_kg=-1"], "hull.mass_kg: Input should be greater"),
        (["reference_auv", "--control-period", "0"], "control_period_s"),
        (
            ["reference_auv", "--set", "control.gains.bandwidth_rad_s=[30,9,9,9,9,9]"],
            "control.gains.bandwidth_rad_s of surge: 30 rad/s makes the loop unstable",
        ),
    ],
)
def test_what_is_not_right_is_said_in_one_line(capsys, arguments, message):
    assert main(["tune", *arguments]) == 2
    text = capsys.readouterr()
    assert text.out == ""
    assert text.err.startswith("error: ")
    assert message in text.err
    assert len(text.err.splitlines()) == 1
