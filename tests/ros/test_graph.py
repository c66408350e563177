"""The real graph on real DDS: lockstep is repeatable and equals the in-process simulation."""

import numpy as np
import pytest
from graph import Outcome, column, finished, uvms, uvms_here

from uvms_analysis.log.compare import compare
from uvms_core import topics

DURATION = "6"
SAME = (
    (topics.TRUE_ODOMETRY, "position"),
    (topics.TRUE_ODOMETRY, "quaternion"),
    (topics.TRUE_ODOMETRY, "nu"),
    (topics.TRUE_JOINT_STATES, "position"),
    (topics.ODOMETRY, "position"),
    (topics.DISTURBANCE, "wrench"),
    (topics.WRENCH_COMMAND, "wrench"),
    (topics.THRUSTER_COMMAND, "thrust"),
)


@pytest.fixture(scope="module")
def separate(tmp_path_factory) -> Outcome:
    folder = tmp_path_factory.mktemp("separate")
    return finished(uvms(folder, "run", "manipulation", "--duration", DURATION, "--seed", "7"))


@pytest.fixture(scope="module")
def composed(tmp_path_factory) -> Outcome:
    folder = tmp_path_factory.mktemp("composed")
    arguments = ("run", "manipulation", "--duration", DURATION, "--seed", "7", "--composed")
    return finished(uvms(folder, *arguments))


@pytest.fixture(scope="module")
def simulated(tmp_path_factory) -> Outcome:
    folder = tmp_path_factory.mktemp("simulated")
    return finished(
        uvms_here(folder, "simulate", "manipulation", "--duration", DURATION, "--seed", "7")
    )


@pytest.mark.parametrize("pair", ["separate", "composed"])
def test_the_graph_in_lockstep_equals_the_simulation(pair, simulated, request):
    graph, alone = request.getfixturevalue(pair).log, simulated.log
    for topic, name in SAME:
        ours, theirs = column(graph, topic, name), column(alone, topic, name)
        assert ours.shape == theirs.shape, topic.name
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-9, err_msg=topic.name)


def test_the_same_seed_gives_the_same_messages_on_every_topic(separate, composed):
    """All but /diagnostics, which tells wall times; test_transforms.py compares the frames."""
    apart = (topics.DIAGNOSTICS, topics.TF)
    compared = [topic for topic in topics.ALL if topic.signal is not None and topic not in apart]
    for difference in compare(separate.log, composed.log, compared):
        assert difference.recorded == difference.replayed == difference.common > 0, difference
        assert difference.greatest == 0.0, difference


def test_a_lockstep_run_is_complete(separate):
    summary = separate.summary
    assert summary["completed"] is True
    assert summary["lockstep_timeouts"] == 0
    assert summary["sim_duration_s"] == pytest.approx(float(DURATION))
    ticks = round(float(DURATION) / 0.05) + 1
    log = separate.log
    for topic in (topics.ODOMETRY, topics.THRUSTER_COMMAND, topics.CLOCK, topics.ALLOCATION):
        assert len(log.series(topic)) == ticks, topic.name
    assert len(log.series(topics.IMU)) == round(100 * float(DURATION)) + 1


def test_every_topic_of_the_table_is_in_the_log(separate):
    log = separate.log
    assert [topic.name for topic in topics.ALL if not log.has(topic)] == []


def test_the_log_tells_where_it_comes_from(separate):
    log = separate.log
    assert {"config.yaml", "vehicle.yaml", "path.json"} <= set(log.attachments)
    assert log.run["seed"] == "7"
    assert log.run["scenario"] == "manipulation"
    assert log.run["git_revision"]


def test_another_seed_is_another_run(simulated, tmp_path):
    other = finished(
        uvms_here(tmp_path, "simulate", "manipulation", "--duration", DURATION, "--seed", "8")
    )
    ours = column(simulated.log, topics.IMU, "angular_velocity")
    assert np.abs(ours - column(other.log, topics.IMU, "angular_velocity")).max() > 1e-6


def test_real_time_follows_the_wall_clock(tmp_path):
    # As slow as time itself: on a loaded machine commands come late, and the run is then invalid.
    arguments = ("run", "hover", "--duration", "8", "--pace", "realtime:1", "--composed")
    outcome = finished(uvms(tmp_path, *arguments))
    stamps = outcome.log.series(topics.CLOCK).time
    assert np.allclose(np.diff(stamps), 0.05)
    assert outcome.summary["wall_s"] >= 0.95 * 8.0
    assert outcome.summary["end_effector_error_m"]["max"] < 0.1
