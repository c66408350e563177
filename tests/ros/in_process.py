"""Nodes of the graph inside the test process, on a ROS domain of their own."""

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import rclpy
from graph import own_domain
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.signals import SignalHandlerOptions

from uvms_core.messages import from_message, to_message
from uvms_core.ros.convert import message_class, to_ros
from uvms_core.ros.spin import Spinner
from uvms_core.ros.subscribe import qos_profile
from uvms_core.topics import Topic


class Peer(Node):
    """The test's own node: publishes signals and keeps what it hears."""

    def __init__(self, heard: Sequence[Topic] = (), spoken: Sequence[Topic] = ()) -> None:
        super().__init__("peer")
        self.heard: dict[str, list[Any]] = {topic.name: [] for topic in heard}
        self._publishers_by_name = {topic.name: self._speak(topic) for topic in spoken}
        for topic in heard:
            self._hear(topic)

    def say(self, topic: Topic, signal: Any, names: Sequence[str] = ()) -> None:
        """Publish a signal as a real rclpy message."""
        message = to_ros(message_class(topic), to_message(topic, signal, names))
        self._publishers_by_name[topic.name].publish(message)

    def _speak(self, topic: Topic) -> Any:
        profile: QoSProfile = qos_profile(topic.qos)
        return self.create_publisher(message_class(topic), topic.name, profile)

    def _hear(self, topic: Topic) -> None:
        def receive(msg: Any) -> None:
            self.heard[topic.name].append(from_message(topic, msg))

        profile = qos_profile(topic.qos)
        self.create_subscription(message_class(topic), topic.name, receive, profile)


def parameters(**values: Any) -> list[Parameter]:
    """Parameter overrides of a node."""
    return [Parameter(name, value=value) for name, value in values.items()]


@contextmanager
def graph_of(*makers: Callable[[], Node]) -> Iterator[tuple[Spinner, list[Node]]]:
    """Nodes in one executor, on a domain of their own."""
    domain = int(own_domain()["ROS_DOMAIN_ID"])
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    rclpy.init(domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
    try:
        nodes = [make() for make in makers]
        spinner = Spinner(nodes)
        try:
            yield spinner, nodes
        finally:
            spinner.shutdown()
    finally:
        rclpy.try_shutdown()


def spin_until(spinner: Spinner, ready: Callable[[], bool], rounds: int = 600) -> None:
    """Serve callbacks until `ready()`, at most for `rounds` of 50 ms."""
    for _ in range(rounds):
        if ready():
            return
        spinner.spin_once(0.05)
    raise AssertionError("what was waited for did not come")
