"""Who publishes on the topics of a graph: counts endpoints and names those that do not belong.

The middleware keeps the endpoints of a process that was killed in the graph for LEASE_S. Fast DDS
writes the host and the process into the first bytes of an endpoint's identifier (vendor, host,
process, random: two bytes each, the process's low ones first), so that such an endpoint can be told
from a live one, and a live one can be named by its process. Elsewhere every endpoint counts as
live.
"""

import os
import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from rclpy.node import Node

FAST_DDS = bytes((0x01, 0x0F))
UNNAMED = "_NODE_NAME_UNKNOWN_"
NAMED_S = 2.0
"""Wall time for the name of an endpoint's node to arrive; after that it counts without one."""
LEASE_S = 25.0
"""Wall time after which a killed process has left the graph for certain: the lease of Fast DDS is
20 s. An endpoint that is still there then is live, wherever its process runs."""


@dataclass(frozen=True)
class Endpoint:
    """A publisher in the graph: topic as the node names it, node with its namespace, identifier."""

    topic: str
    node: str
    gid: bytes

    @property
    def who(self) -> str:
        """The node, and its process where that can be told."""
        return f"{self.node}{describe_process(self.gid)}"

    @property
    def is_ours(self) -> bool:
        """Whether it is known to come from this very process."""
        return os.getpid() in processes_of(self.gid)

    def __str__(self) -> str:
        return f"{self.who} publishes {self.topic!r}"


class Publishers:
    """Watches who publishes on some topics.

    Args:
        node: that looks.
        allowed: how many publishers each topic may have, by name.
    """

    def __init__(self, node: Node, allowed: Mapping[str, int]) -> None:
        self._node, self._allowed = node, dict(allowed)
        self._known: set[bytes] = set()
        self._ended: set[bytes] = set()
        self._first_seen: dict[bytes, float] = {}
        self._host: bytes = b""

    def know(self) -> None:
        """Those that are there now belong here."""
        for topic in self._allowed:
            self._known |= {each.gid for each in self._all(topic)}

    def expect_again(self, node: str) -> None:
        """The present endpoints of this node do not count any more: it is dead."""
        for topic in self._allowed:
            self._ended |= {
                each.gid for each in self._all(topic) if each.node.rpartition("/")[2] == node
            }

    def strangers(self) -> list[Endpoint]:
        """Live publishers beyond the allowed number; of these, the ones that are not known."""
        found: list[Endpoint] = []
        for topic, allowed in self._allowed.items():
            if self._node.count_publishers(topic) > allowed:  # cheap, unlike what follows
                live = self.live(topic)
                if len(live) > allowed:
                    found += [each for each in live if each.gid not in self._known] or live
        return found

    def live(self, topic: str) -> list[Endpoint]:
        """Publishers of a topic, without those of processes that were killed."""
        return [one for one in self._all(topic) if self._is_live(one.gid) and self._is_named(one)]

    def _all(self, topic: str) -> list[Endpoint]:
        return [
            Endpoint(topic, _full_name(info), bytes(info.endpoint_gid))
            for info in self._node.get_publishers_info_by_topic(topic)
        ]

    def _is_named(self, each: Endpoint) -> bool:
        """The graph learns of an endpoint before it learns of its node; soon it knows both."""
        since = self._first_seen.setdefault(each.gid, time.monotonic())
        return UNNAMED not in each.node or time.monotonic() - since > NAMED_S

    def _is_live(self, gid: bytes) -> bool:
        if gid in self._ended:
            return False
        since = self._first_seen.setdefault(gid, time.monotonic())
        return time.monotonic() - since > LEASE_S or not self._is_dead(gid)

    def _is_dead(self, gid: bytes) -> bool:
        """Whether it came from a process of this host that is not there any more."""
        host = self._own_host()
        return bool(host) and gid[:4] == host and not processes_of(gid)

    def _own_host(self) -> bytes:
        """Vendor and host in the identifiers of this process; empty where nobody can tell."""
        if not self._host:
            own = self._node.get_publishers_info_by_topic("/rosout")
            mine = [bytes(i.endpoint_gid) for i in own if i.node_name == self._node.get_name()]
            mine = [gid for gid in mine if os.getpid() in processes_of(gid)]
            self._host = mine[0][:4] if mine else b""
        return self._host


def _full_name(info: object) -> str:
    namespace = getattr(info, "node_namespace", "/").rstrip("/")
    return f"{namespace}/{getattr(info, 'node_name', '?')}"


def processes_of(gid: bytes) -> list[int]:
    """Processes of this machine that may own an endpoint; empty where nobody can tell."""
    if gid[:2] != FAST_DDS:
        return []
    low = gid[4] | gid[5] << 8
    numbers = (int(name) for name in _names(Path("/proc")) if name.isdigit())
    return [number for number in numbers if number & 0xFFFF == low and not _is_zombie(number)]


def describe_process(gid: bytes) -> str:
    """The process of an endpoint in words, with a space before; empty where nobody can tell."""
    lines = [(number, _command(number)) for number in processes_of(gid)]
    return "".join(f" (process {number}: {command})" for number, command in lines if command)


def _names(folder: Path) -> Iterable[str]:
    return os.listdir(folder) if folder.is_dir() else ()


def _command(process: int) -> str:
    try:
        raw = Path(f"/proc/{process}/cmdline").read_bytes()
    except OSError:
        return ""
    return raw.replace(b"\0", b" ").decode(errors="replace").strip()[:160]


def _is_zombie(process: int) -> bool:
    try:
        return b") Z " in Path(f"/proc/{process}/stat").read_bytes()
    except OSError:
        return True
