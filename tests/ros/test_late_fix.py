"""A graph whose navigation does not know at first where it is: time goes on, and goals wait."""

import pytest
import yaml
from graph import finished, uvms, uvms_here

from uvms_analysis.log.compare import compare
from uvms_analysis.log.read import RunLog
from uvms_core import topics

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
    outcome = finished(uvms_here(tmp_path, "run", str(file), "--composed"))
    summary = outcome.summary
    assert (summary["outcome"], summary["lockstep_timeouts"]) == ("completed", 0), summary
    assert [goal["state"] for goal in summary["goals"]] == ["succeeded", "succeeded"]
    assert summary["goals"][0]["began_s"] >= 3.0  # GPS comes at whole seconds
    assert summary["navigation_error_m"]["max"] < 0.1


@pytest.fixture(scope="module")
def simulated(tmp_path_factory):
    """The same without the graph."""
    folder = tmp_path_factory.mktemp("late")
    file = folder / "late_fix.yaml"
    file.write_text(yaml.safe_dump(SCENARIO), encoding="utf-8")
    return finished(uvms_here(folder / "run", "simulate", str(file)))


@pytest.mark.parametrize(
    ("node", "topic"),
    [(topics.NAVIGATION, topics.ODOMETRY), (topics.MOTION_PLANNER, topics.REFERENCE)],
)
def test_a_node_answers_in_a_replay_as_it_did(simulated, tmp_path, node, topic):
    """Nobody waits for an odometry that there was not; both goals begin where they began."""
    log = str(simulated.folder / "run.mcap")
    outcome = finished(uvms_here(tmp_path, "replay", log, "--into", node))
    assert "0 unanswered" in outcome.out
    again = RunLog.open(tmp_path / "replay.mcap")
    (difference,) = compare(simulated.log, again, [topic])
    assert difference.recorded == difference.replayed == difference.common > 15, difference
    assert difference.greatest == 0.0, difference


def test_in_real_time_the_vehicle_drifts_until_there_is_a_fix_and_the_run_is_valid(tmp_path):
    """No odometry, no wrench and no torque before it; the goal begins then."""
    scenario = SCENARIO | {"duration_s": 10.0, "goals": SCENARIO["goals"][:1]}
    file = tmp_path / "late_fix.yaml"
    file.write_text(yaml.safe_dump(scenario), encoding="utf-8")
    arguments = ("run", str(file), "--composed", "--pace", "realtime")
    outcome = finished(uvms(tmp_path / "run", *arguments))
    log = outcome.log
    known = log.signals(topics.ODOMETRY)[0].stamp
    assert known >= 3_000_000_000
    assert log.signals(topics.REFERENCE)[0].stamp >= known
    early = [each for each in log.signals(topics.THRUSTER_COMMAND) if each.stamp < known]
    assert not any(each.thrust.any() for each in early)
    assert outcome.summary["goals"][0]["state"] == "succeeded"
    assert outcome.summary["goals"][0]["began_s"] >= 3.0
