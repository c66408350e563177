"""Joint states that come late, on the real graph: as in the process, and nothing waits for them."""

import pytest
from graph import Outcome, finished, uvms_here

from uvms_analysis.log.compare import compare
from uvms_analysis.log.read import RunLog
from uvms_core import topics

LATENCY = 100_000_000
SCENARIO = """
description: the arm moves while its encoders are late by two ticks, and then again in time
duration_s: 3.0
seed: 5
vehicle: reference_auv
goal: {joints: {times_s: [3.0], positions_deg: [[10.0, 5.0, 130.0, 0.0]]}}
events:
  - {at_s: 0.7, until_s: 2.0, sensor: encoders, fault: latency, latency_s: 0.1}
"""


@pytest.fixture(scope="module")
def runs(tmp_path_factory) -> tuple[Outcome, Outcome]:
    folder = tmp_path_factory.mktemp("late")
    (folder / "late.yaml").write_text(SCENARIO)
    name = str(folder / "late.yaml")
    graph = finished(uvms_here(folder / "graph", "run", name, "--composed"))
    return graph, finished(uvms_here(folder / "alone", "simulate", name))


def test_the_graph_in_lockstep_equals_the_simulation(runs):
    graph, alone = (outcome.log for outcome in runs)
    compared = [
        topic
        for topic in topics.ALL
        if topic.signal is not None and topic is not topics.DIAGNOSTICS and topic is not topics.TF
    ]
    for difference in compare(graph, alone, [*compared, topics.SENSOR_GAPS]):
        assert difference.recorded == difference.replayed == difference.common > 0, difference
        assert difference.greatest == 0.0, difference


def test_each_tick_is_answered_and_none_counts_as_lost(runs):
    for outcome in runs:
        assert outcome.summary["lockstep_timeouts"] == 0
        assert outcome.summary["check"]["faults"] == []
        assert len(list(outcome.log.signals(topics.WRENCH_COMMAND))) == 61


def test_the_plant_says_which_joint_states_have_come(runs):
    for outcome in runs:
        gaps = {each.stamp: each for each in outcome.log.signals(topics.SENSOR_GAPS)}
        late = {
            stamp: dict(zip(each.sensors, each.newest, strict=True))["encoders"]
            for stamp, each in gaps.items()
            if "encoders" in each.sensors
        }
        assert min(late) == 700_000_000
        assert max(late) == 2_050_000_000  # with the samples of 1.95, 2 and 2.05 s
        assert late[700_000_000] == late[750_000_000] == 650_000_000
        steady = [stamp for stamp in late if 800_000_000 <= stamp < 2_050_000_000]
        assert len(steady) == 25
        assert all(stamp - late[stamp] == LATENCY for stamp in steady)


@pytest.mark.parametrize(
    ("node", "topic"),
    [
        (topics.CONTROLLER, topics.WRENCH_COMMAND),
        (topics.DISTURBANCE_OBSERVER, topics.DISTURBANCE),
    ],
)
def test_a_node_replays_a_log_with_late_joint_states(runs, tmp_path, node, topic):
    replayed = finished(
        uvms_here(tmp_path, "replay", str(runs[0].folder / "run.mcap"), "--into", node)
    )
    (difference,) = compare(runs[0].log, RunLog.open(replayed.folder / "replay.mcap"), [topic])
    assert difference.recorded == difference.replayed == difference.common == 61
    assert difference.greatest == 0.0
