"""Asks the nodes whether each has found its peers: a lost first tick would stall lockstep."""

from collections.abc import Iterable

from rclpy.node import Node
from std_srvs.srv import Trigger

from uvms_core.ros.request import ASK_AGAIN_S, Request

NOT_UP = "has not come up"
NO_ANSWER = "is up but does not answer"


class RollCall:
    """Polls the nodes' `ready` services, without waiting.

    Args:
        node: that asks.
        names: of the nodes that are asked.
        again_s: wall time after which a node that does not answer is asked again, s.
    """

    def __init__(self, node: Node, names: Iterable[str], again_s: float = ASK_AGAIN_S) -> None:
        self._clients = {name: node.create_client(Trigger, f"{name}/ready") for name in names}
        self._again_s = again_s
        self._requests = {name: self._request(name) for name in self._clients}
        self.lacks = dict.fromkeys(self._clients, NOT_UP)
        """What each node lacks, in words; empty where it is ready."""

    def poll(self) -> dict[str, str]:
        """Take the answers that have come, ask again who is not ready, and tell what is lacking."""
        for name, lack in self.lacks.items():
            if lack:
                self.lacks[name] = self._ask(name, lack)
        return {name: lack for name, lack in self.lacks.items() if lack}

    def _ask(self, name: str, lack: str) -> str:
        request = self._requests[name]
        answer = request.answer()
        if answer is None:
            return NO_ANSWER if request.times_asked > 1 else lack
        self._requests[name] = self._request(name)
        return "" if answer.success else answer.message

    def _request(self, name: str) -> Request:
        client = self._clients[name]
        return Request(
            lambda: client.call_async(Trigger.Request()), client.service_is_ready, self._again_s
        )
