"""A graph whose navigation does not know at first where it is: time goes on, and goals wait."""

import yaml
from graph import finished, uvms

SCENARIO = {
    "scenario": "late_fix",
    "duration_s": 12.0,
    "vehicle_overrides": {"sensors.gps.horizontal_noise_m": 0.02},
    "plant": {"initial_position_m": [12.0, -7.0, 0.2], "initial_posture": "home"},
    "navigation": {"start": "fixes", "initial_position_m": [0.0, 0.0, 0.0]},
    "goals": [
        {"pose": {"position_m": [12.0, -7.0, 0.22], "frame": "map_ned", "hold_s": 1.0}},
        {"joints": {"times_s": [2.0], "positions_deg": [[0.0, 10.0, 112.0, 0.0]]}},
    ],
    "events": [{"at_s": 0.0, "until_s": 2.5, "sensor": "gps", "fault": "silent"}],
}


def test_the_run_goes_on_until_there_is_a_fix_and_then_does_its_goals(tmp_path):
    file = tmp_path / "late_fix.yaml"
    file.write_text(yaml.safe_dump(SCENARIO), encoding="utf-8")
    outcome = finished(uvms(tmp_path, "run", str(file), "--composed"))
    summary = outcome.summary
    assert (summary["outcome"], summary["lockstep_timeouts"]) == ("completed", 0), summary
    assert [goal["state"] for goal in summary["goals"]] == ["succeeded", "succeeded"]
    assert summary["goals"][0]["began_s"] >= 3.0  # GPS comes at whole seconds
    assert summary["navigation_error_m"]["max"] < 0.1
