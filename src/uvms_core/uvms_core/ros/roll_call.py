"""Checks who is there: a run cannot start before its nodes have found each other.

A role of the graph is filled by one of our nodes, which answers its service `ready`, or by anybody
else's node, which only has to publish what the others read of that role.
"""

from collections.abc import Collection, Iterable, Mapping

from rclpy.node import Node
from std_srvs.srv import Trigger

from uvms_core import topics
from uvms_core.ros.request import ASK_AGAIN_S, Request
from uvms_core.topic import NodeTopics, Topic

NOT_UP = "has not come up"
NO_ANSWER = "is up but does not answer"
SEPARATOR = "; "
"""Between the parts of an answer."""


class RollCall:
    """Polls whether every role is filled and ready, without waiting.

    Args:
        node: that asks.
        roles: that are asked for.
        foreign: roles that somebody else's node fills; None: those that have no service `ready`.
        again_s: wall time after which a node that does not answer is asked again, s.
        graph: what each node reads and writes, `topics.nodes(vehicle)`.
    """

    def __init__(
        self,
        node: Node,
        roles: Iterable[str],
        foreign: Collection[str] | None = (),
        again_s: float = ASK_AGAIN_S,
        graph: Mapping[str, NodeTopics] = topics.NODES,
    ) -> None:
        self._node, self._foreign, self._again_s, self._graph = node, foreign, again_s, graph
        self._clients = {role: node.create_client(Trigger, f"{role}/ready") for role in roles}
        self._requests = {role: self._request(role) for role in self._clients}
        self._answers: dict[str, list[str]] = {role: [NOT_UP] for role in self._clients}

    @property
    def foreign(self) -> set[str]:
        """Roles that somebody else's node fills, or that nobody fills yet."""
        if self._foreign is not None:
            return set(self._foreign)
        clients = self._clients.items()
        return {role for role, client in clients if not client.service_is_ready()}

    def poll(self) -> dict[str, str]:
        """Take the answers that have come, ask again; what each role lacks, by role, in words."""
        foreign = self.foreign
        lacks = {role: self._lacks(role, foreign) for role in self._clients}
        return {role: SEPARATOR.join(lack) for role, lack in lacks.items() if lack}

    def _lacks(self, role: str, foreign: set[str]) -> list[str]:
        if role in foreign:
            return [
                nobody_publishes(topic)
                for topic in self._graph[role].outputs
                if topic not in topics.COMPANIONS
                and topics.readers(topic, self._graph) - foreign
                and not self._node.count_publishers(topic.name)
            ]
        if self._answers[role]:
            self._answers[role] = self._ask(role)
        idle = unread(foreign, self._graph)
        return [lack for lack in self._answers[role] if lack not in idle]

    def _ask(self, role: str) -> list[str]:
        request = self._requests[role]
        answer = request.answer()
        if answer is None:
            return [NO_ANSWER] if request.times_asked > 1 else self._answers[role]
        self._requests[role] = self._request(role)
        return [] if answer.success else answer.message.split(SEPARATOR)

    def _request(self, role: str) -> Request:
        client = self._clients[role]
        return Request(
            lambda: client.call_async(Trigger.Request()), client.service_is_ready, self._again_s
        )


def nobody_publishes(topic: Topic) -> str:
    """What a node lacks that nobody gives it."""
    return f"nobody publishes {topic.name!r} ({topic.type})"


def nobody_reads(topic: Topic) -> str:
    """What a node lacks that nobody listens to."""
    return f"nobody subscribes to {topic.name!r} ({topic.type})"


def unread(foreign: set[str], graph: Mapping[str, NodeTopics]) -> set[str]:
    """Lacks that do not count: only nodes of somebody else's could read these topics."""
    read = {topic for own in graph.values() for topic in own.inputs}
    return {nobody_reads(topic) for topic in read if topics.readers(topic, graph) <= foreign}
