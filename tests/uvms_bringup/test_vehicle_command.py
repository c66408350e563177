"""The command `uvms vehicle`, and the warnings of a run."""

import json

import pytest

from uvms_bringup.cli import main

SINKS = "hull.mass_kg=370"


def test_the_summary_is_for_people(capsys):
    assert main(["vehicle", "bluerov2_alpha5"]) == 0
    text = capsys.readouterr().out
    assert text.startswith("warning: thrusters: the 6 of them cannot push along pitch alone")
    assert "mass 15.702 kg, displaces 15.717 kg: 0.1472 N up" in text
    assert "pitch            0 to 0        N m  out of reach" in text
    assert "extended_starboard         1.5 mm  upper_arm and hull" in text


def test_the_json_is_for_scripts(capsys):
    assert main(["vehicle", "reference_auv", "--json", "--set", SINKS]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["errors"] == data["notes"] == []
    assert any("it sinks with 1820 N" in line for line in data["warnings"])
    summary = data["summary"]
    assert summary["net_buoyancy_n"] == pytest.approx(-1820.2, abs=0.5)
    assert summary["authority"]["surge"] == pytest.approx([-98.0, 98.0])
    assert summary["joints"]["shoulder"]["brake_nm"] == 25.0
    least = {"least_m": pytest.approx(0.0390, abs=5e-5), "pair": "upper_arm and hull"}
    assert summary["clearance"]["extended_port"] == least


def test_errors_end_in_code_2(capsys):
    wrong = ["--set", "hull.cb_m=[50, 0, 0]"]
    assert main(["vehicle", "reference_auv", *wrong]) == 2
    assert "error: " in capsys.readouterr().err
    assert main(["vehicle", "reference_auv", "--json", *wrong]) == 2
    data = json.loads(capsys.readouterr().out)
    assert data["summary"] is None
    assert any("hull.cb_m: 50 m along x" in line for line in data["errors"])


@pytest.mark.parametrize("setting", ["hull.mass_kg", "=3", "hull.mass_kg=[", "hull.mas_kg=3"])
def test_a_wrong_setting_is_named(capsys, setting):
    assert main(["vehicle", "reference_auv", "--set", setting]) == 2
    assert setting.split("=")[0] in capsys.readouterr().err


def test_a_run_prints_the_warnings_once(capsys, tmp_path):
    options = ["--duration", "0.1", "--output", str(tmp_path / "run")]
    main(["simulate", "hover", *options, "--set", f"vehicle.{SINKS}"])
    assert capsys.readouterr().err.count("warning: vehicle: hull.mass_kg: vehicle and arm") == 1
