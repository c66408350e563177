"""What should be in a log by the nodes' own counts, on real DDS: lost, foreign, started again."""

import time

import numpy as np
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.node import Node

from uvms_bringup.ros import losses as module
from uvms_bringup.ros.losses import Losses
from uvms_bringup.ros.recorder import Recorder
from uvms_control.nodes.thrust_allocator import ThrustAllocatorNode
from uvms_core import topics
from uvms_core.signals import ThrusterCommand, Wrench
from uvms_core.vehicle import load_vehicle

ROLE, OUT = topics.THRUST_ALLOCATOR, topics.THRUSTER_COMMAND
PERIOD = 50_000_000


class Scribe(Node):
    """The conductor's own counting, without its run."""

    def __init__(self):
        super().__init__("scribe")
        recorded = (*topics.NODES[ROLE].outputs, topics.DIAGNOSTICS)
        self.recorder = Recorder(self, lambda *message: None, recorded)
        self.losses = Losses(self, self.recorder, [ROLE])

    @property
    def received(self):
        return self.recorder.received[OUT.name]


def allocator():
    return ThrustAllocatorNode(parameter_overrides=parameters(pace="realtime"))


def peer():
    return Peer((), (topics.WRENCH_COMMAND, OUT))


def met(spinner, node, scribe, other):
    """All have found each other."""
    spin_until(
        spinner,
        lambda: (
            node.count_publishers(OUT.name) == 2
            and node._outputs[OUT].get_subscription_count() == 1
            and other._publishers_by_name[OUT.name].get_subscription_count() == 1
            and other._publishers_by_name[topics.WRENCH_COMMAND.name].get_subscription_count() == 1
        ),
    )


def answered(spinner, scribe, other, numbers):
    """The node answers commands of these ticks, one by one."""
    for number in numbers:
        before = scribe.received
        other.say(topics.WRENCH_COMMAND, Wrench(number * PERIOD, np.zeros(6)))
        spin_until(spinner, lambda b=before: scribe.received > b)


def test_messages_of_somebody_else_are_more_than_was_sent(saw):
    with graph_of(allocator, Scribe, peer) as (spinner, (node, scribe, other)):
        met(spinner, node, scribe, other)
        spin_until(spinner, scribe.losses.begun)
        answered(spinner, scribe, other, range(1, 6))
        thrust = np.zeros(len(load_vehicle().thruster_names))
        other.say(OUT, ThrusterCommand(6 * PERIOD, thrust), load_vehicle().thruster_names)
        spin_until(spinner, lambda: scribe.received == 6)
        spin_until(spinner, scribe.losses.ended)
        assert scribe.losses.sent()["/thruster_command"] == 5
        assert scribe.losses.lost() == {}
    saw("one foreign message between two censuses", "6 received, 5 sent: told apart")


def test_a_node_that_is_started_again_counts_from_zero():
    with graph_of(allocator, Scribe, peer) as (spinner, (node, scribe, other)):
        met(spinner, node, scribe, other)
        spin_until(spinner, scribe.losses.begun)
        answered(spinner, scribe, other, range(1, 6))
        spinner._executor.remove_node(node)
        node.destroy_node()
        scribe.losses.restart(ROLE)
        due = time.monotonic() + module.IN_FLIGHT_S
        spin_until(spinner, lambda: time.monotonic() > due)
        scribe.losses.look()
        again = allocator()
        spinner.add([again])
        met(spinner, again, scribe, other)
        answered(spinner, scribe, other, range(6, 9))
        spin_until(spinner, scribe.losses.ended)
        assert scribe.losses.sent()["/thruster_command"] == scribe.received == 8
        assert scribe.losses.lost() == {}
