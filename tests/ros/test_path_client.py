"""The example client on the whole graph: a circle in either frame, its feedback, and cancelling."""

import numpy as np
import pytest
from example_clients import imported
from in_process import Peer, spin_until
from led_graph import running
from test_actions import path_from_start

from uvms_core.signals import to_nanoseconds
from uvms_core.topics import REFERENCE


@pytest.fixture
def example(monkeypatch):
    """The module of the example."""
    yield from imported(monkeypatch, "path_client")


def followed(example, folder, frame, duration_s=120.0):
    """Where the tool was in map_ned (k, 3) while a client led it round a circle in `frame`."""
    makers = [lambda: example.PathClient(frame), lambda: Peer(heard=[REFERENCE])]
    with running(folder, duration_s, None, *makers) as (spinner, conductor, client, peer):
        spin_until(spinner, lambda: client.ready)
        times, positions = example.circle(client.tool, 0.01, 8.0)
        client.send(times, positions)
        spin_until(spinner, lambda: client.ending is not None)
        assert (client.ending, conductor.goal_handle) == ("succeeded", None), client.message
        assert client.feedback.duration == pytest.approx(8.0)
        assert client.feedback.tracking_error < 0.02
    way = [reference.end_effector[-1] for reference in peer.heard[REFERENCE.name]]
    return np.array(way) - positions[0] @ example.FRAMES[frame]


def test_a_circle_is_the_same_in_map_with_its_axes_changed(example, tmp_path):
    """In map_ned it goes out to the north, in map out to the east; nowhere up or down."""
    north = followed(example, tmp_path, "map_ned")
    east = followed(example, tmp_path, "map")
    for way, out, across in ((north, 0, 1), (east, 1, 0)):
        assert way[:, out].max() == pytest.approx(0.02, abs=5e-4)
        assert way[:, out].min() > -5e-4
        assert np.abs(way[:, across]).max() < 0.0105
        assert np.abs(way[:, 2]).max() < 1e-4


def test_what_is_cancelled_ends_so(example, tmp_path):
    with running(tmp_path, 60.0, None, lambda: example.PathClient("map")) as (
        spinner,
        conductor,
        client,
    ):
        spin_until(spinner, lambda: client.ready)
        client.send(*example.circle(client.tool, 0.05, 50.0))
        spin_until(spinner, lambda: client.feedback is not None)
        client.cancel()
        spin_until(spinner, lambda: client.ending is not None)
        assert conductor.stamp < to_nanoseconds(50.0)
    assert (client.ending, client.message) == ("cancelled", "cancelled")


def test_a_path_takes_the_place_of_the_runs_own(example, tmp_path):
    """It is planned while the vehicle goes on, and begins where that has brought it."""
    goal = path_from_start(200.0, (0.0, 0.0, 0.5))
    with running(tmp_path, 200.0, goal, lambda: example.PathClient("map_ned")) as (
        spinner,
        conductor,
        client,
    ):
        spin_until(spinner, lambda: client.ready)
        spin_until(spinner, lambda: conductor.stamp > to_nanoseconds(20.0))
        client.send(*example.circle(client.tool, 0.02, 15.0))
        spin_until(spinner, lambda: conductor.result is not None)
        assert conductor.goal_failure() == ["the run's goal: pre-empted by a new goal"]
        spin_until(spinner, lambda: client.ending is not None)
        assert client.ending == "succeeded", client.message
        assert client.feedback.tracking_error < 0.02


def test_what_cannot_be_followed_is_told_to_be_rejected(example, tmp_path):
    with running(tmp_path, 20.0, None, lambda: example.PathClient("map")) as (spinner, _, client):
        spin_until(spinner, lambda: client.ready)
        client.send(*example.circle(client.tool, 40.0, 4.0))
        spin_until(spinner, lambda: client.ending is not None)
    assert client.ending == "rejected"
    assert "diagnostics" in client.message
