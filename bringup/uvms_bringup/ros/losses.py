"""Which messages never reached the log: what the nodes say they sent against what was recorded."""

import json
import time
from collections import Counter
from collections.abc import Collection, Mapping

from rclpy.client import Client
from rclpy.node import Node
from std_srvs.srv import Trigger

from uvms_bringup.ros.recorder import Recorder
from uvms_core import topics
from uvms_core.ros.request import Request
from uvms_core.topic import Topic

AGAIN_S = 1.0
"""Wall time after which a node that does not answer is asked again."""
IN_FLIGHT_S = 0.2
"""Wall time after the death of a node in which its last messages arrive. Another one takes longer
to start: it has to load the interpreter and the vehicle."""


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

    def silent(self) -> list[str]:
        """Who has not answered."""
        return [role for role in self._requests if role not in self.answers]


def _request(client: Client) -> Request:
    return Request(lambda: client.call_async(Trigger.Request()), client.service_is_ready, AGAIN_S)


class Losses:
    """What should be in the log of a run: counts of its nodes, start by start.

    A node that was started again counts from zero, and what it sent before it died nobody knows: of
    its topics, what had been received by then is taken for granted. Messages of before the start,
    such as a node's first state, may come too early for the recorder and belong to no run: of them,
    too, what was received counts. Every other message that is in the log was counted by a node, or
    somebody else sent it, however briefly. /diagnostics has many publishers, and nodes that have to
    wait write there before time runs: of it alone, surplus messages prove nothing.

    What was received is read before the nodes are asked, so that a message on its way is never
    taken for lost.

    Args:
        node: that asks.
        recorder: of the run.
        roles: whose nodes count what they send.
    """

    def __init__(self, node: Node, recorder: Recorder, roles: Collection[str]) -> None:
        self._clients = {role: node.create_client(Trigger, f"{role}/sent") for role in roles}
        self._namespace = node.get_namespace()
        self._received = recorder.received
        self._before: Counter[str] = Counter()  # received messages that no count is about
        self._counted: dict[str, Counter[str]] = {}  # sent by role, at the start of its counting
        self._restarted: dict[str, float] = {}  # wall time, until messages of the dead are in
        self._first: Count | None = None
        self._last: Count | None = None

    def begun(self) -> bool:
        """Count at the start; whether that is done."""
        if self._first is None:
            self._before = Counter(self._received)
            self._first = Count(self._clients)
        if not self._first.poll():
            return False
        self._counted = {role: Counter(sent) for role, sent in self._first.answers.items()}
        return True

    def restart(self, role: str) -> None:
        """The node of this role died, and another that counts from zero is on its way."""
        if role in self._counted:
            self._restarted[role] = time.monotonic() + IN_FLIGHT_S

    def look(self) -> None:
        """Now and then: take stock of what the dead had sent."""
        for role, due in list(self._restarted.items()):
            if time.monotonic() >= due:
                self._take_over(role)

    def _take_over(self, role: str) -> None:
        del self._restarted[role]
        for name in self._counted[role]:
            self._before[name] = self._received[name]
        self._counted[role] = Counter(dict.fromkeys(self._counted[role], 0))

    def ended(self) -> bool:
        """Count at the end; whether that is done and nothing that was counted is missing."""
        for role in list(self._restarted):
            self._take_over(role)
        self._last = self._last or Count(self._clients)
        return self._last.poll() and not self._missing()

    def silent(self) -> list[str]:
        """Whose count is missing at the end."""
        return [] if self._last is None else self._last.silent()

    def lost(self) -> dict[str, int]:
        """Messages that were sent during the run and never received, by full name of the topic."""
        return {self._full(name): number for name, number in sorted(self._missing().items())}

    def sent(self) -> dict[str, int]:
        """Messages that should be in the log by what the nodes say, by full name of the topic."""
        return {self._full(name): number for name, number in sorted(self._sent().items())}

    def _sent(self) -> Counter[str]:
        if self._first is None or self._last is None:
            return Counter()
        sent: Counter[str] = Counter()
        for role, last in self._last.answers.items():
            first = self._counted.get(role, Counter())
            for name, number in last.items():
                sent[name] += number - first[name]
        for name in sent:
            sent[name] += self._before[name]
            if name == topics.DIAGNOSTICS.name:
                sent[name] = max(sent[name], self._received[name])
        return sent

    def _missing(self) -> Counter[str]:
        return self._sent() - Counter(self._received)  # of counters: what is above zero alone

    def _full(self, name: str) -> str:
        return Topic(name, "").resolve(self._namespace)
