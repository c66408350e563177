"""Asks the nodes whether each has found its peers: a lost first tick would stall lockstep."""

from collections.abc import Iterable
from typing import Any

from rclpy.node import Node
from std_srvs.srv import Trigger

NOT_UP = "has not come up"


class RollCall:
    """Polls the nodes' `ready` services, without waiting.

    Args:
        node: that asks.
        names: of the nodes that are asked.
    """

    def __init__(self, node: Node, names: Iterable[str]) -> None:
        self._clients = {name: node.create_client(Trigger, f"{name}/ready") for name in names}
        self._asked: dict[str, Any] = {}
        self.lacks = dict.fromkeys(self._clients, NOT_UP)
        """What each node lacks, in words; empty where it is ready."""

    def poll(self) -> dict[str, str]:
        """Take the answers that have come, ask again who is not ready, and tell what is lacking."""
        for name, client in self._clients.items():
            self._take_answer(name)
            if self.lacks[name] and name not in self._asked and client.service_is_ready():
                self._asked[name] = client.call_async(Trigger.Request())
        return {name: lack for name, lack in self.lacks.items() if lack}

    def _take_answer(self, name: str) -> None:
        answer = self._asked.get(name)
        if answer is not None and answer.done():
            del self._asked[name]
            self.lacks[name] = "" if answer.result().success else answer.result().message
