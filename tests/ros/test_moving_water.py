"""Water that moves, on the real graph: what a scenario says of it reaches the plant's node."""

import numpy as np
from graph import column, finished, uvms_here

from uvms_core import topics

FLOW = (
    "plant.current={constant_ned_m_s: [-0.08, 0.06, 0.0], turning: {speed_m_s: 0.1},"
    " gusts: [{at_s: 0.2, duration_s: 1.5, rise_s: 0.5, velocity_ned_m_s: [0.0, 0.3, 0.0]}],"
    " oscillating: [{amplitude_m_s: 0.1, period_s: 3.0}],"
    " waves: [{height_m: 0.3, period_s: 8.0, water_depth_m: 50.0, direction_deg: 90.0}]}"
)
SETTINGS = ("--set", "plant.current_ned_m_s=[0, 0, 0]", "--duration", "2", "--set", FLOW)


def test_the_graph_has_the_water_of_the_simulation(tmp_path):
    graph = finished(uvms_here(tmp_path / "graph", "run", "hover", *SETTINGS, "--composed")).log
    alone = finished(uvms_here(tmp_path / "alone", "simulate", "hover", *SETTINGS)).log
    for topic, name in ((topics.TRUE_ODOMETRY, "position"), (topics.TRUE_ODOMETRY, "nu")):
        ours, theirs = column(graph, topic, name), column(alone, topic, name)
        assert ours.shape == theirs.shape
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9)
    moved = column(alone, topics.TRUE_ODOMETRY, "position")
    assert np.ptp(moved[:, 1]) > 0.02
