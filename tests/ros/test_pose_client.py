"""The example client for poses on the whole graph: either frame, cancelling, and pre-emption."""

import numpy as np
import pytest
from example_clients import imported
from in_process import spin_until
from led_graph import running
from test_actions import path_from_start

from uvms_bringup.scenario import load_scenario
from uvms_core.signals import JointGoal, to_nanoseconds


@pytest.fixture
def example(monkeypatch):
    """The module of the example."""
    yield from imported(monkeypatch, "pose_client")


@pytest.mark.parametrize("frame", ["map", "map_ned"])
def test_the_vehicle_goes_where_it_is_sent_in_either_frame(example, tmp_path, frame):
    with running(tmp_path, 60.0, None, lambda: example.PoseClient(frame)) as (
        spinner,
        conductor,
        client,
    ):
        spin_until(spinner, lambda: client.ready)
        start, heading = client.position, client.yaw
        client.send(start + [0.3, 0.1, 0.0], heading + 0.1, hold=2.0)
        spin_until(spinner, lambda: client.ending is not None)
        assert client.ending == "succeeded", client.message
        assert client.feedback.distance < 0.03
        assert client.feedback.turn < 0.02
        off = client.position - start - [0.3, 0.1, 0.0]
        assert np.linalg.norm(off) < 0.03
        assert client.yaw - heading == pytest.approx(0.1, abs=0.02)
        assert conductor.interference() == ["the planner accepted 1 goals that were not this run's"]


def test_what_is_cancelled_ends_so_and_a_goal_may_follow_while_it_comes_to_rest(example, tmp_path):
    with running(tmp_path, 90.0, None, lambda: example.PoseClient("map_ned")) as (
        spinner,
        conductor,
        client,
    ):
        spin_until(spinner, lambda: client.ready)
        start = client.position
        client.send(start + [4.0, 0.0, 0.0], 0.0)
        spin_until(spinner, lambda: client.feedback is not None and client.feedback.elapsed > 6.0)
        client.cancel()
        spin_until(spinner, lambda: client.ending is not None)
        assert (client.ending, client.message) == ("cancelled", "cancelled")
        again = type(client)("map_ned")
        spinner.add([again])
        spin_until(spinner, lambda: again.ready)
        again.send(start, 0.0)
        spin_until(spinner, lambda: again.ending is not None)
        assert again.ending == "succeeded"
        assert np.linalg.norm(again.position - start) < 0.05
        assert conductor.stamp > to_nanoseconds(6.0)


@pytest.mark.parametrize("kind", ["path", "joints"])
def test_a_run_whose_goal_somebody_else_ends_does_not_count_it_as_done(example, tmp_path, kind):
    goal = path_from_start(60.0, (0.0, 0.0, 0.1))
    if kind == "joints":
        scenario = load_scenario("manipulation")
        angles = np.radians(scenario.load_vehicle().arm.stowed_deg)
        goal = JointGoal(np.array([60.0]), angles[None] + [0.1, 0.1, -0.1, 0.0])
    with running(tmp_path, 60.0, goal, lambda: example.PoseClient("map")) as (
        spinner,
        conductor,
        client,
    ):
        spin_until(spinner, lambda: client.ready)
        spin_until(spinner, lambda: conductor.stamp > to_nanoseconds(5.0))
        client.send(client.position + [0.2, 0.0, 0.0], client.yaw)
        spin_until(spinner, lambda: conductor.result is not None)
        assert conductor.goal_state() == "aborted"
        assert conductor.goal_failure() == ["the run's goal: pre-empted by a new goal"]
        spin_until(spinner, lambda: client.ending is not None)
        assert client.ending == "succeeded", client.message
        assert "the planner accepted 1 goals that were not this run's" in conductor.interference()


def test_a_pose_that_is_rejected_leaves_the_goal_before_it_alone(example, tmp_path):
    goal = path_from_start(20.0, (0.0, 0.0, 0.1))
    with running(tmp_path, 40.0, goal, lambda: example.PoseClient("map")) as (
        spinner,
        conductor,
        client,
    ):
        spin_until(spinner, lambda: client.ready)
        client.send(np.array([0.0, 0.0, 5.0]), 0.0)
        spin_until(spinner, lambda: client.ending is not None)
        assert client.ending == "rejected"
        assert "diagnostics" in client.message
        spin_until(spinner, lambda: conductor.result is not None)
        assert conductor.goal_state() == "succeeded"
        assert conductor.interference() == conductor.goal_failure() == []
