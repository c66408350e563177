"""What our nodes share: parameters, topics by table, the tick gate, diagnostics, readiness."""

import json
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Literal, TypeVar

from pydantic import Field
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_srvs.srv import Trigger

from uvms_core import diagnostics, topics
from uvms_core.cdr import codec
from uvms_core.config import Config
from uvms_core.diagnostics import Status
from uvms_core.errors import PlantDiverged, PluginError, UvmsError
from uvms_core.messages import from_message, to_message
from uvms_core.ros.convert import message_class
from uvms_core.ros.parameters import declare_config
from uvms_core.ros.roll_call import SEPARATOR, nobody_publishes, nobody_reads
from uvms_core.signals import NANOSECONDS, to_nanoseconds
from uvms_core.tick_gate import Input, Tick, TickGate
from uvms_core.timing import CONTROL_PERIOD_S, ControlPeriod
from uvms_core.topics import Qos, Topic
from uvms_core.vehicle import Vehicle, load_vehicle

C = TypeVar("C", bound=Config)
DIAGNOSTICS_PERIOD = NANOSECONDS


def qos_profile(qos: Qos) -> QoSProfile:
    """The rclpy form of a topic's quality of service."""
    durability = (
        DurabilityPolicy.TRANSIENT_LOCAL if qos.transient_local else DurabilityPolicy.VOLATILE
    )
    return QoSProfile(
        depth=qos.depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability
    )


class NodeConfig(Config):
    """Parameters that every node of the loop has."""

    vehicle_file: str = Field("", description="vehicle file; empty: the reference vehicle")
    seed: int = Field(1, ge=0, description="seed of this run's random numbers")
    pace: Literal["lockstep", "realtime"] = Field(
        "lockstep",
        description="lockstep (repeatable: wait for all inputs of a stamp) or realtime (use the "
        "newest); the same for all nodes",
    )
    control_period_s: ControlPeriod = CONTROL_PERIOD_S


class UvmsNode(Node):
    """A thin shell around a core class: parameters in, messages to signals, signals to messages.

    Messages go straight between CDR bytes and signals (raw subscriptions and publishers), which
    takes a fifth of the time that filling rclpy's message objects would.

    A subclass makes its core in `__init__`, then calls `connect`. It keeps its last good state
    when an input is refused: the fault is logged, counted and reported on /diagnostics.
    """

    role = ""
    """Its name in the graph, and its row in the table of topics."""
    configurations: tuple[type[Config], ...] = ()
    """Configurations whose fields are its parameters."""

    def __init__(self, **options: Any) -> None:
        name = self.role
        super().__init__(name, **options)
        common = self.config(NodeConfig)
        self.vehicle: Vehicle = load_vehicle(common.vehicle_file or None)
        self.seed = common.seed
        self.lockstep = common.pace == "lockstep"
        self.period = to_nanoseconds(common.control_period_s)
        self.graph = topics.nodes(self.vehicle)
        self._topics = self.graph[name]
        # What some node of the loop reads: a run cannot start before it has a subscriber.
        self._needed = {t for n in self.graph.values() for t in n.inputs} - {topics.CLOCK}
        self._outputs: dict[Topic, Publisher] = {}
        self._sent: dict[str, int] = {}  # messages by topic's name, for whoever counts the lost
        self._senders = {topic: self._sender(topic) for topic in self._topics.outputs}
        self._diagnostics = self._sender(topics.DIAGNOSTICS)
        self._status = Status(0, name)
        self._reported = -DIAGNOSTICS_PERIOD
        self._refused = 0
        self._gate: TickGate | None = None
        self._receivers: dict[Topic, Any] = {}
        self.create_service(Trigger, f"{name}/ready", self._answer_ready)
        self.create_service(Trigger, f"{name}/sent", self._answer_sent)

    def config(self, model: type[C]) -> C:
        """The node's configuration from its ROS parameters."""
        return declare_config(self, model)

    def connect(
        self,
        inputs: Mapping[Topic, Input],
        trigger: Topic,
        on_tick: Callable[[Tick], None],
        in_loop: bool = True,
        every: int = 1,
    ) -> None:
        """Subscribe to the inputs and call `on_tick` when those of one stamp are there.

        `in_loop` and `every` are as in `TickGate`.
        """
        by_name = {topic.name: rule for topic, rule in inputs.items()}
        self._gate = TickGate(by_name, trigger.name, self.lockstep, in_loop, every)
        self._on_tick = on_tick
        for topic in inputs:
            self.listen(topic, partial(self._admit, topic))

    def listen(self, topic: Topic, callback: Callable[[Any], None]) -> None:
        """Subscribe; the callback gets checked signals, and its faults are reported."""
        names, wire = self.names_of(topic), codec(topic.type)

        def receive(data: bytes) -> None:
            self.guard(lambda: callback(from_message(topic, wire.decode(data), names)))

        self._receivers[topic] = self.create_subscription(
            message_class(topic), topic.name, receive, qos_profile(topic.qos), raw=True
        )

    def send(self, topic: Topic, signal: Any) -> None:
        """Publish a signal on its topic."""
        self._senders[topic](signal)

    def guard(self, action: Callable[[], None]) -> None:
        """Run a step; an error of ours is reported and the node keeps its last good state.

        A plant that diverged and a part with a mistake have no good state: that ends the node.
        """
        try:
            action()
        except (PlantDiverged, PluginError) as fault:
            self.report(self._status.stamp, diagnostics.ERROR, str(fault))
            raise
        except UvmsError as fault:
            self.refuse(self._status.stamp, [fault])

    def refuse(self, stamp: int, faults: Sequence[UvmsError]) -> None:
        """Log, count and report inputs that are not used."""
        for fault in faults:
            self._refused += 1
            self.get_logger().error(str(fault), throttle_duration_sec=1.0)
            self.report(stamp, diagnostics.ERROR, str(fault))

    def report(
        self, stamp: int, level: int = diagnostics.OK, message: str = "ok", **values: Any
    ) -> None:
        """Publish this node's state on /diagnostics."""
        gate = self._gate
        counts = {"refused": self._refused}
        if gate is not None:
            counts |= {"abandoned_ticks": gate.abandoned, "late": gate.late}
        self._status = Status(stamp, self.get_name(), level, message, counts | values)
        self._diagnostics(self._status)
        self._reported = stamp

    def report_each_second(self, stamp: int, **values: Any) -> None:
        """As `report`, at most once a second of simulation time."""
        if stamp - self._reported >= DIAGNOSTICS_PERIOD:
            self.report(stamp, **values)

    def names_of(self, topic: Topic) -> tuple[str, ...]:
        """Names of the topic's values: of thrusters or of joints."""
        by_thruster = topic in (
            topics.THRUSTER_COMMAND,
            topics.ALLOCATION,
            topics.APPLIED_THRUST,
        )
        return self.vehicle.thruster_names if by_thruster else self.vehicle.joint_names

    def missing_peers(self) -> list[str]:
        """What this node is still missing before a run can start, as text.

        Each of its endpoints must have matched every peer in the graph: messages published before
        that are lost.
        """
        lacks = []
        for topic, subscription in self._receivers.items():
            there, found = self.count_publishers(topic.name), subscription.get_publisher_count()
            if found < max(there, 1):
                lacks.append(_lack(nobody_publishes(topic), there, found))
        for topic, publisher in self._outputs.items():
            there, found = self.count_subscribers(topic.name), publisher.get_subscription_count()
            if found < max(there, 1 if topic in self._needed else 0):
                lacks.append(_lack(nobody_reads(topic), there, found))
        return lacks

    def _admit(self, topic: Topic, signal: Any) -> None:
        for tick in self._gate.push(topic.name, signal.stamp, signal) if self._gate else ():
            self._status = Status(tick.stamp, self.get_name())
            self._on_tick(tick)
            self.report_each_second(tick.stamp)

    def _sender(self, topic: Topic) -> Callable[[Any], None]:
        names, wire = self.names_of(topic), codec(topic.type)
        publisher = self.create_publisher(message_class(topic), topic.name, qos_profile(topic.qos))
        self._outputs[topic] = publisher
        sent, key = self._sent, topic.name
        sent[key] = 0

        def publish(signal: Any) -> None:
            publisher.publish(wire.encode(to_message(topic, signal, names)))
            sent[key] += 1

        return publish

    def _answer_ready(self, _: Any, response: Any) -> Any:
        lacks = self.missing_peers()
        response.success, response.message = not lacks, SEPARATOR.join(lacks)
        return response

    def _answer_sent(self, _: Any, response: Any) -> Any:
        response.success, response.message = True, json.dumps(self._sent)
        return response


def _lack(nobody: str, there: int, found: int) -> str:
    """Nobody is there, or some are there that have not been found yet."""
    if not there:
        return nobody
    return f"{nobody.removeprefix('nobody ')}: {there - found} of {there} not found yet"
