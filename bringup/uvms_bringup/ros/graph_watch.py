"""Who else is in the graph: refuses an occupied one before a run, notices intruders during it."""

import time
from collections.abc import Collection, Mapping

from rclpy.node import Node

from uvms_bringup.errors import RunError
from uvms_core import topics
from uvms_core.ros.endpoints import Publishers
from uvms_core.topic import NodeTopics

DISCOVERY_S = 3.5
"""Wall time in which a node finds who is in the graph already, on a loaded machine, too."""
REST_S = 1.0
"""Wall time from the first of them until all are found."""
LOOK_S = 0.5
"""Wall time between two looks during a run."""
CONDUCTOR = "conductor"


class GraphWatch:
    """Counts the publishers of the loop's topics and of /clock.

    Args:
        node: that looks.
        graph: what each role reads and writes.
        absent: roles that are left to the user.
    """

    def __init__(
        self, node: Node, graph: Mapping[str, NodeTopics], absent: Collection[str] = ()
    ) -> None:
        self._node = node
        self._roles = set(graph) - set(absent)
        own = {topic.name for role in self._roles for topic in graph[role].outputs}
        everybody = {topic.name for each in graph.values() for topic in each.outputs}
        self._before = Publishers(node, dict.fromkeys(own, 0))
        self._during = Publishers(node, dict.fromkeys(everybody, 1))
        self._due = 0.0
        self.foreign: tuple[str, ...] = ()

    def check_alone(self) -> None:
        """Before the run's own nodes are in the graph.

        Raises:
            RunError: somebody else is there; names who, and what to do.
        """
        if found := self._others():
            raise RunError(self._occupied(found))

    def sees_others(self) -> bool:
        """Whether somebody is there before the run's own nodes."""
        return bool(self._others())

    def _others(self) -> list[str]:
        strangers = self._before.strangers()
        return sorted({str(each) for each in strangers}) or self._same_names()

    def check_alone_with_nodes(self) -> None:
        """When the run's own nodes are all there: whoever comes now does not belong.

        Raises:
            RunError: somebody else has come in the meantime.
        """
        if strangers := self._during.strangers():
            raise RunError(self._occupied([str(each) for each in strangers]))
        self._during.know()

    def expect_again(self, role: str) -> None:
        """The node of this role died; another takes its place."""
        self._during.expect_again(role)

    def look(self) -> bool:
        """From time to time: note who does not belong; whether somebody was ever found."""
        now = time.monotonic()
        if now >= self._due:
            self._due = now + LOOK_S
            texts = {str(each) for each in self._during.strangers()}
            self.foreign = tuple(sorted({*self.foreign, *texts}))
        return bool(self.foreign)

    def _occupied(self, found: list[str]) -> str:
        domain = self._node.context.get_domain_id()
        return (
            f"ROS_DOMAIN_ID={domain} is occupied: {'; '.join(found)}. End whoever does not belong,"
            " set another ROS_DOMAIN_ID, or set none, so that a free one is chosen"
        )

    def _same_names(self) -> list[str]:
        """Nodes of our names in our namespace that publish no topic of the loop (yet)."""
        space = self._node.get_namespace().rstrip("/")
        names = {f"{space}/{role}" for role in self._roles}
        conductor = f"{space}/{CONDUCTOR}"
        there = self._before.live(topics.ROSOUT.name)  # every node publishes there
        others = [each for each in there if each.node == conductor and not each.is_ours]
        return [each.who for each in there if each.node in names] + [one.who for one in others]
