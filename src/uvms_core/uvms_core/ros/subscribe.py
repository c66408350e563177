"""Subscriptions to the nodes of this project, and to drivers that publish as drivers do."""

from collections.abc import Callable
from typing import Any

from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from uvms_core.topic import Qos, Topic


def qos_profile(qos: Qos, best_effort: bool = False) -> QoSProfile:
    """The rclpy form of a topic's quality of service."""
    durability = (
        DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE
    )
    reliability = ReliabilityPolicy.BEST_EFFORT if best_effort else ReliabilityPolicy.RELIABLE
    return QoSProfile(depth=qos.depth, reliability=reliability, durability=durability)


class Subscriber:
    """A reliable subscription, as the topics of this project are published.

    In real time it hears publishers that are best effort as well, which drivers of sensors often
    are: where one appears, a second subscription is made for it, which does not match the others.
    In lockstep a lost sample would stop the run, so that such a publisher is only named.

    Args:
        node: that subscribes.
        message: class of the messages.
        topic: to subscribe to.
        receive: gets the bytes of each message.
        lockstep: whether every sample must arrive.
    """

    def __init__(
        self,
        node: Node,
        message: Any,
        topic: Topic,
        receive: Callable[[bytes], None],
        lockstep: bool,
    ) -> None:
        self._node, self._message, self._topic, self._receive = node, message, topic, receive
        self._lockstep, self._best_effort = lockstep, False
        events = SubscriptionEventCallbacks(incompatible_qos=self._on_incompatible)
        self.subscriptions = [self._subscribe(False, event_callbacks=events)]

    @property
    def name(self) -> str:
        """The topic's name in the graph."""
        name: str = self.subscriptions[0].topic_name
        return name

    def get_publisher_count(self) -> int:
        """How many publishers it has found."""
        return sum(each.get_publisher_count() for each in self.subscriptions)

    def _subscribe(self, best_effort: bool, **options: Any) -> Any:
        profile = qos_profile(self._topic.qos, best_effort)
        return self._node.create_subscription(
            self._message, self._topic.name, self._receive, profile, raw=True, **options
        )

    def _on_incompatible(self, info: Any) -> None:
        if self._best_effort:
            return
        self._best_effort = True
        name, log = self._topic.name, self._node.get_logger()
        if self._lockstep:
            log.error(f"{name}: its publisher is best effort; in lockstep it must be reliable")
        else:
            log.info(f"{name}: its publisher is best effort, so that samples may be lost")
            self.subscriptions.append(self._subscribe(True))
