"""What users know of thrusters, by service and by topic on real DDS."""

import math

import numpy as np
import pytest
from in_process import graph_of, parameters, spin_until
from rclpy.node import Node

from uvms_control.nodes.thrust_allocator import ThrustAllocatorNode
from uvms_msgs.msg import ThrusterHealth
from uvms_msgs.srv import SetThrusterHealth


def _allocator() -> ThrustAllocatorNode:
    overrides = parameters(effectiveness="{side_aft: 0.5}")
    return ThrustAllocatorNode(parameter_overrides=overrides)


@pytest.fixture
def graph():
    with graph_of(_allocator, lambda: Node("user")) as (spinner, (allocator, user)):
        yield spinner, allocator, user


def _ask(spinner, user, names, shares) -> SetThrusterHealth.Response:
    client = user.create_client(SetThrusterHealth, "set_thruster_health")
    spin_until(spinner, client.service_is_ready)
    request = SetThrusterHealth.Request(thruster_names=names, effectiveness=shares)
    future = client.call_async(request)
    spin_until(spinner, future.done)
    return future.result()


def test_the_service_says_what_is_believed_and_what_remains(graph):
    spinner, _, user = graph
    answer = _ask(spinner, user, ["main"], [0.0])
    assert answer.success, answer.message
    assert "main gives 0% (told)" in answer.message
    assert "surge 0%" in answer.message
    believed = dict(zip(answer.all_thruster_names, answer.believed, strict=True))
    assert believed["main"] == 0.0
    assert believed["side_aft"] == 0.5
    assert answer.authority[0] == 0.0
    assert answer.authority[2] == pytest.approx(4 * 49.0)
    answer = _ask(spinner, user, ["main"], [math.nan])
    assert answer.success
    assert answer.authority[0] == pytest.approx(98.0)


@pytest.mark.parametrize(
    ("names", "shares", "words"),
    [
        (["bow"], [0.0], "choose from main"),
        (["main"], [2.0], "2 is not within 0 (dead) to 1.2"),
        (["main"], [], "1 names and 0 shares"),
    ],
)
def test_a_wrong_word_is_refused_and_says_why(graph, names, shares, words):
    spinner, _, user = graph
    answer = _ask(spinner, user, names, shares)
    assert not answer.success
    assert words in answer.message
    assert answer.believed[0] == 1.0


def test_the_topic_does_the_same(graph):
    spinner, allocator, user = graph
    publisher = user.create_publisher(ThrusterHealth, "thruster_health", 10)
    spin_until(spinner, lambda: publisher.get_subscription_count() == 1)
    publisher.publish(ThrusterHealth(thruster_names=["heave_not"], effectiveness=[0.0]))
    publisher.publish(ThrusterHealth(thruster_names=["side_fore"], effectiveness=[0.0]))
    belief = allocator.part.thrusters.belief
    spin_until(spinner, lambda: belief.effectiveness[1] == 0.0)
    assert np.delete(belief.effectiveness, [1, 2]) == pytest.approx(1.0)
