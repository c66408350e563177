"""Which messages never reached the log: what the nodes say they sent against what was recorded."""

import json
from collections import Counter
from collections.abc import Collection, Mapping

from rclpy.client import Client
from rclpy.node import Node
from std_srvs.srv import Trigger

from uvms_bringup.ros.recorder import Recorder
from uvms_core.ros.request import Request
from uvms_core.topic import Topic

AGAIN_S = 1.0
"""Wall time after which a node that does not answer is asked again."""


class Count:
    """Asks every node once what it has sent so far, over its service `sent`."""

    def __init__(self, clients: Mapping[str, Client]) -> None:
        self._requests = {role: _request(client) for role, client in clients.items()}
        self.answers: dict[str, dict[str, int]] = {}

    def poll(self) -> bool:
        """Take the answers that have come; whether all have."""
        for role, request in self._requests.items():
            if role not in self.answers and (answer := request.answer()) is not None:
                self.answers[role] = json.loads(answer.message)
        return len(self.answers) == len(self._requests)

    def total(self) -> Counter[str]:
        """Messages by topic's name."""
        total: Counter[str] = Counter()
        for sent in self.answers.values():
            total.update(sent)
        return total

    def silent(self) -> list[str]:
        """Who has not answered."""
        return [role for role in self._requests if role not in self.answers]


def _request(client: Client) -> Request:
    return Request(lambda: client.call_async(Trigger.Request()), client.service_is_ready, AGAIN_S)


class Losses:
    """Counts at the start and at the end of a run; the difference is the run's.

    Messages of before the start, such as a node's first state, may come too early for the recorder
    and belong to no run. What was received is read before the nodes are asked, so that a message on
    its way is never taken for lost.

    Args:
        node: that asks.
        recorder: of the run.
        roles: whose nodes count what they send.
    """

    def __init__(self, node: Node, recorder: Recorder, roles: Collection[str]) -> None:
        self._clients = {role: node.create_client(Trigger, f"{role}/sent") for role in roles}
        self._namespace = node.get_namespace()
        self._received = recorder.received
        self._before: Counter[str] = Counter()
        self._first: Count | None = None
        self._last: Count | None = None

    def begun(self) -> bool:
        """Count at the start; whether that is done."""
        if self._first is None:
            self._before = Counter(self._received)
            self._first = Count(self._clients)
        return self._first.poll()

    def ended(self) -> bool:
        """Count at the end; whether that is done and nothing that was counted is missing."""
        self._last = self._last or Count(self._clients)
        return self._last.poll() and not self._missing()

    def silent(self) -> list[str]:
        """Whose count is missing at the end."""
        return [] if self._last is None else self._last.silent()

    def lost(self) -> dict[str, int]:
        """Messages that were sent during the run and never received, by full name of the topic."""
        return {self._full(name): number for name, number in sorted(self._missing().items())}

    def sent(self) -> dict[str, int]:
        """Messages of the topics that were counted: received ones and lost ones, by full name."""
        counted = {} if self._last is None else self._last.total()
        missing = self._missing()
        return {self._full(name): self._received[name] + missing[name] for name in sorted(counted)}

    def _missing(self) -> Counter[str]:
        if self._first is None or self._last is None:
            return Counter()
        # The difference of counters keeps what is above zero alone: a node that was started again
        # counts from zero, and what it sent before is received, but not in its count.
        sent = self._last.total() - self._first.total()
        return sent - (Counter(self._received) - self._before)

    def _full(self, name: str) -> str:
        return Topic(name, "").resolve(self._namespace)
