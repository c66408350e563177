"""The real nodes on a wire of bytes: what one publishes, all others get at once, without DDS.

Everything of a node runs as in a real graph but for the transport, many times faster than it; time
is the plant's, at pace `realtime`.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import rclpy
from graph import own_domain
from in_process import parameters
from rclpy.signals import SignalHandlerOptions

from uvms_control.nodes.controller import ControllerNode
from uvms_control.nodes.thrust_allocator import ThrustAllocatorNode
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.messages import from_message
from uvms_core.topics import Topic
from uvms_dynamics.nodes.plant import PlantNode
from uvms_observer.nodes.disturbance_observer import DisturbanceObserverNode
from uvms_observer.nodes.navigation import NavigationNode
from uvms_planner.nodes.motion_planner import MotionPlannerNode

NODES = {
    topics.PLANT: PlantNode,
    topics.NAVIGATION: NavigationNode,
    topics.DISTURBANCE_OBSERVER: DisturbanceObserverNode,
    topics.MOTION_PLANNER: MotionPlannerNode,
    topics.CONTROLLER: ControllerNode,
    topics.THRUST_ALLOCATOR: ThrustAllocatorNode,
}
OUTPUTS = [t for t in topics.ALL if t.signal not in (None, int) and t is not topics.TF]


class _Spout:
    """In place of a publisher."""

    def __init__(self, wire: "Wire", name: str) -> None:
        self._wire, self._name = wire, name

    def publish(self, data: bytes) -> None:
        self._wire.put(self._name, data)

    def get_subscription_count(self) -> int:
        return 1


class Wire:
    """Nodes by role and what goes to and fro between them."""

    def __init__(self) -> None:
        self.nodes: dict[str, Any] = {}
        self._readers: dict[str, dict[str, Callable[[bytes], None]]] = {}
        self._queue: list[tuple[str, bytes]] = []
        self._busy = False
        self.heard: dict[str, list[Any]] = {}
        self.last: dict[str, bytes] = {}
        self.good: dict[str, bytes] = {}
        self.cut: set[str] = set()
        self.change: Callable[[str, bytes], bytes] = lambda name, data: data

    def add(self, role: str, cls: type | None = None, **values: Any) -> Any:
        """Start the node of a role, or start it again."""
        wire = self
        for readers in self._readers.values():
            readers.pop(role, None)

        class Driven(cls or NODES[role]):  # type: ignore[misc]
            def create_subscription(self, kind, name, callback, qos, **more):
                if more.get("raw"):
                    wire._readers.setdefault(name, {})[role] = callback
                return super().create_subscription(kind, name, callback, qos, **more)

            def create_publisher(self, kind, name, *rest, **more):
                if name in topics.BY_NAME:
                    super().create_publisher(kind, name, *rest, **more)
                    return _Spout(wire, name)
                return super().create_publisher(kind, name, *rest, **more)

        values = {"pace": "realtime"} | values
        if role == topics.PLANT:
            values = {"auto_start": False} | values
        self.nodes[role] = Driven(parameter_overrides=parameters(**values))
        return self.nodes[role]

    def remove(self, role: str) -> None:
        """Kill a node."""
        for readers in self._readers.values():
            readers.pop(role, None)
        self.nodes.pop(role).destroy_node()

    def put(self, name: str, data: bytes) -> None:
        """Publish bytes; they are delivered in order, after what is being delivered."""
        if name in self.cut:
            return
        data = self.change(name, data)
        self.last[name] = data
        self._listen(name, data)
        self._queue.append((name, data))
        if self._busy:
            return
        self._busy = True
        try:
            while self._queue:
                topic, bits = self._queue.pop(0)
                for read in list(self._readers.get(topic, {}).values()):
                    read(bits)
        finally:
            self._busy = False

    def inject(self, name: str, data: bytes) -> None:
        """Somebody else publishes bytes, which nobody checks here."""
        for read in list(self._readers.get(name, {}).values()):
            read(data)

    def _listen(self, name: str, data: bytes) -> None:
        topic = topics.BY_NAME[name]
        if topic in OUTPUTS:  # raises for whatever is not finite
            self.heard.setdefault(name, []).append(
                from_message(topic, codec(topic.type).decode(data))
            )

    @property
    def plant(self) -> Any:
        return self.nodes[topics.PLANT]._plant

    def start(self) -> None:
        self.nodes[topics.PLANT]._start()

    def run(self, seconds: float, each: Callable[[], None] = lambda: None) -> None:
        """Let the plant go on; `each` is called before every tick."""
        for _ in range(round(seconds / 0.05)):
            each()
            self.nodes[topics.PLANT]._advance()

    def since(self, topic: Topic, stamp: int) -> list[Any]:
        """Signals of a topic that are later than a stamp."""
        return [signal for signal in self.heard.get(topic.name, []) if signal.stamp > stamp]

    def count(self, role: str, key: str) -> int:
        """A count that a node reports."""
        node = self.nodes[role]
        counts = {"refused": node._refused, **node.more_counts(), **node._intake.counts}
        return counts[key]

    def works(self, seconds: float = 0.5) -> bool:
        """Whether every node answers every tick for a while, and the plant uses the answers."""
        begin = self.plant.stamp
        self.run(seconds)
        ticks = round(seconds / 0.05)
        answers = (
            topics.ODOMETRY,
            topics.DISTURBANCE,
            topics.WRENCH_COMMAND,
            topics.THRUSTER_COMMAND,
            topics.JOINT_COMMAND,
        )
        whole = all(len(self.since(topic, begin)) >= ticks for topic in answers)
        used = all(not a.thruster_safe for a in self.since(topics.APPLIED_THRUST, begin)[2:])
        return whole and used and bool(np.isfinite(self.since(topics.ODOMETRY, begin)[-1].nu).all())

    def drift(self) -> float:
        """Distance of the true vehicle from where it was at the start, m."""
        odometry = self.heard[topics.TRUE_ODOMETRY.name]
        return float(np.linalg.norm(odometry[-1].position - odometry[0].position))


@contextmanager
def wire(*roles: str, **values: Any) -> Iterator[Wire]:
    """A wire with all nodes, or those of some roles."""
    domain = int(own_domain()["ROS_DOMAIN_ID"])
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    rclpy.init(domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
    made = Wire()
    try:
        for role in roles or NODES:
            made.add(role, **values)
        yield made
    finally:
        for node in made.nodes.values():
            node.destroy_node()
        rclpy.try_shutdown()
