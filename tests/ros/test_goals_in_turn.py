"""Several goals on the graph in lockstep: each begins where the one before it has ended."""

import numpy as np
import pytest
import yaml
from graph import column, finished, uvms_here

from uvms_core import topics

POSE = {"position_m": [12.0, -7.0, 0.5], "frame": "map_ned"}
SCENARIO = {
    "scenario": "in_turn",
    "duration_s": 20.0,
    "vehicle_overrides": {"sensors.gps.horizontal_noise_m": 0.02},
    "plant": {"initial_position_m": [12.0, -7.0, 0.2], "initial_posture": "home"},
    "goals": [
        {"pose": {**POSE, "hold_s": 1.0}},
        {"path": {"frame": "start", "phases": [{"duration_s": 4.0, "to_m": [0.0, 0.0, 0.04]}]}},
        {"pose": {**POSE, "hold_s": 0.5}},
    ],
}
LATE = {
    "duration_s": 18.0,
    "goals": [{"pose": {**POSE, "hold_s": 1.0}}, {"pose": {**POSE, "hold_s": 0.5}}],
    "navigation": {"start": "fixes", "initial_position_m": [0.0, 0.0, 0.0]},
    "events": [{"at_s": 0.0, "until_s": 2.5, "sensor": "gps", "fault": "silent"}],
}
SAME = (
    (topics.TRUE_ODOMETRY, "position"),
    (topics.TRUE_JOINT_STATES, "position"),
    (topics.ODOMETRY, "position"),
    (topics.WRENCH_COMMAND, "wrench"),
    (topics.THRUSTER_COMMAND, "thrust"),
)


@pytest.mark.parametrize("further", [{}, LATE], ids=["known", "late"])
def test_the_graph_equals_the_simulation(tmp_path, further):
    """A path takes its time to be planned; in simulated time none passes, nor before the first."""
    file = tmp_path / "in_turn.yaml"
    file.write_text(yaml.safe_dump(SCENARIO | further), encoding="utf-8")
    graph = finished(uvms_here(tmp_path / "graph", "run", str(file), "--composed"))
    alone = finished(uvms_here(tmp_path / "alone", "simulate", str(file)))
    goals = len((SCENARIO | further)["goals"])
    for outcome in (graph, alone):
        summary = outcome.summary
        assert (summary["outcome"], summary["lockstep_timeouts"]) == ("completed", 0), summary
        assert [goal["state"] for goal in summary["goals"]] == ["succeeded"] * goals, summary
    for topic, name in SAME:
        ours, theirs = column(graph.log, topic, name), column(alone.log, topic, name)
        assert ours.shape == theirs.shape, topic.name
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=topic.name)
