"""Baselines on the real graph: navigation from the truth, and no observer."""

import numpy as np
import pytest
from graph import Outcome, column, finished, uvms_here

from uvms_core import topics

OPTIONS = ("--duration", "4", "--set", "navigation.source=truth", "--set", "observer=none")
SAME = (
    (topics.TRUE_ODOMETRY, "position"),
    (topics.TRUE_ODOMETRY, "nu"),
    (topics.ODOMETRY, "position"),
    (topics.DISTURBANCE, "wrench"),
    (topics.THRUSTER_COMMAND, "thrust"),
)


@pytest.fixture(scope="module")
def graph(tmp_path_factory) -> Outcome:
    folder = tmp_path_factory.mktemp("graph")
    return finished(uvms_here(folder, "run", "hover", *OPTIONS, "--composed"))


def test_the_graph_equals_the_simulation(graph, tmp_path):
    alone = finished(uvms_here(tmp_path, "simulate", "hover", *OPTIONS))
    for topic, name in SAME:
        ours, theirs = column(graph.log, topic, name), column(alone.log, topic, name)
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=topic.name)
    assert graph.summary["completed"] is True
    assert graph.summary["lockstep_timeouts"] == 0


def test_the_estimate_is_the_truth_of_the_same_tick(graph):
    for name in ("position", "quaternion", "nu"):
        truth, estimate = (
            column(graph.log, t, name) for t in (topics.TRUE_ODOMETRY, topics.ODOMETRY)
        )
        assert np.array_equal(truth, estimate), name
    assert not column(graph.log, topics.DISTURBANCE, "wrench").any()


def test_the_truth_is_replayed_into_navigation(graph, tmp_path):
    log = str(graph.folder / "run.mcap")
    again = finished(uvms_here(tmp_path, "replay", log, "--into", "navigation"))
    assert " 0 unanswered" in again.out
