"""What our nodes share: parameters, topics by table, the tick gate, diagnostics, readiness."""

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from typing import Any, Literal, TypeVar

import numpy as np
from pydantic import Field
from rclpy.node import Node
from rclpy.publisher import Publisher
from std_srvs.srv import Trigger

from uvms_core import diagnostics, topics
from uvms_core.cdr import codec, stamp_in
from uvms_core.config import Config
from uvms_core.diagnostics import Status
from uvms_core.errors import PlantDiverged, PluginError, SignalError, UvmsError
from uvms_core.intake import Intake
from uvms_core.messages import from_message, to_message
from uvms_core.plausibility import Plausibility
from uvms_core.ros.convert import message_class
from uvms_core.ros.parameters import declare_config
from uvms_core.ros.roll_call import SEPARATOR, nobody_publishes, nobody_reads
from uvms_core.ros.subscribe import Subscriber, qos_profile
from uvms_core.ros.watchdog import LOOK_S, Watchdog
from uvms_core.signals import BY_THRUSTER, NANOSECONDS, to_nanoseconds
from uvms_core.tick_gate import Covering, Delayed, Input, Periodic, Tick, TickGate
from uvms_core.timeline import Jump, Timeline
from uvms_core.timing import CONTROL_PERIOD_S, ControlPeriod
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle, load_vehicle

C = TypeVar("C", bound=Config)
DIAGNOSTICS_PERIOD = NANOSECONDS
COMPLAINTS_S = 0.2
"""Wall time between two reports of inputs that are refused, s: a flood of invalid messages must not
become one of diagnostics. Every one is counted."""


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
    run_id: str = Field(
        "", description="id of the run that the node belongs to, which its diagnostics carry"
    )


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
        self.run_id = common.run_id
        self.lockstep = common.pace == "lockstep"
        self.period = to_nanoseconds(common.control_period_s)
        self.graph = topics.nodes(self.vehicle)
        self._topics = self.graph[name]
        # What some node of the loop reads: a run cannot start before it has a subscriber.
        self._needed = {t for n in self.graph.values() for t in n.inputs} - {topics.CLOCK}
        self._needed -= topics.COMPANIONS
        self._outputs: dict[Topic, Publisher] = {}
        self._sent: dict[str, int] = {}  # messages by topic's name, for whoever counts the lost
        self._senders = {topic: self._sender(topic) for topic in self._topics.outputs}
        self._diagnostics = self._sender(topics.DIAGNOSTICS)
        self._status = Status(0, name)
        self._reported = -DIAGNOSTICS_PERIOD
        self._complained = 0.0
        self._refused = 0
        self._told: dict[str, Any] = {}  # counts that are on /diagnostics
        self.plausibility = Plausibility(self.vehicle)
        self._intake: Intake | None = None
        self._watchdog = Watchdog(time.monotonic())
        self._receivers: dict[Topic, Any] = {}
        self._readers: dict[str, Callable[[bytes], Any]] = {}
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
        gate = TickGate(by_name, trigger.name, self.lockstep, in_loop, every)
        plans = [topic.name for topic, rule in inputs.items() if isinstance(rule, Covering)]
        timeline = Timeline(self.period, plans)
        sampled = topics.sampled_topics(self.vehicle)
        self._intake = Intake(gate, timeline, self.plausibility, self.on_time_jump, sampled)
        self._on_tick = on_tick
        waits = any(isinstance(rule, Delayed | Periodic) for rule in inputs.values())
        for topic in (*inputs, topics.SENSOR_GAPS) if waits else inputs:
            self._subscribe(topic, partial(self._receive, self._intake, topic))

    def listen(
        self,
        topic: Topic,
        callback: Callable[[Any], None],
        on_refused: Callable[[int | None], None] = lambda stamp: None,
    ) -> None:
        """Subscribe; the callback gets checked and possible signals, and its faults are reported.

        The topic is not an input of the node's ticks; see `connect`. `on_refused` is called with
        the stamp of a message that is not used, None where that cannot be read either.
        """
        read = self._reader(topic)

        def checked(data: bytes) -> Any:
            with np.errstate(all="ignore"):  # what overflows is refused
                signal = read(data)
                if topic.signal is not int and topic.signal is not Status:
                    self.plausibility.admit(topic, signal)
            return signal

        def take(data: bytes) -> None:
            try:
                signal = checked(data)
            except UvmsError as fault:
                self.refuse(self._status.stamp, [fault])
                on_refused(stamp_in(data))
            else:
                callback(signal)

        self._subscribe(topic, lambda data: self.guard(lambda: take(data)))

    def _subscribe(self, topic: Topic, receive: Callable[[bytes], None]) -> None:
        self._receivers[topic] = Subscriber(
            self, message_class(topic), topic, receive, self.lockstep
        )

    def _reader(self, topic: Topic) -> Callable[[bytes], Any]:
        """From bytes to a signal; raises UvmsError for whatever is not one."""
        names, wire = self.names_of(topic), codec(topic.type)

        def read(data: bytes) -> Any:
            try:
                return from_message(topic, wire.decode(data), names)
            except UvmsError:
                raise
            except Exception as fault:  # a sensor of another package converts in its own way
                raise SignalError(f"{topic.name}: cannot be read: {fault!r}") from fault

        return read

    def _receive(self, intake: Intake, topic: Topic, data: bytes) -> None:
        """A message of an input of the ticks has come."""
        self.guard(lambda: self._take_in(intake, topic, data))

    def _take_in(self, intake: Intake, topic: Topic, data: bytes) -> None:
        wall = time.monotonic()
        with np.errstate(all="ignore"):  # what overflows is refused
            try:
                signal = self._read_input(topic, data)
            except UvmsError as fault:
                self.refuse(self._status.stamp, [fault])
                self._step_through(intake, intake.take_unreadable(topic, stamp_in(data)))
            else:
                self._step_through(intake, intake.take(topic, signal, wall))
        if self._watchdog.is_due(wall):
            self.on_wake()

    def _read_input(self, topic: Topic, data: bytes) -> Any:
        read = self._readers.get(topic.name)
        if read is None:
            read = self._readers[topic.name] = self._reader(topic)
        return read(data)

    def _step_through(self, intake: Intake, ticks: Iterable[Tick]) -> None:
        for tick in ticks:
            self._watchdog.ticked()
            self._status = Status(tick.stamp, self.get_name(), run_id=self.run_id)
            self._on_tick(tick)
            self.report_each_second(tick.stamp)
        if intake.faults:
            faults, intake.faults = intake.faults, []
            self.refuse(self._status.stamp, faults)
        if intake.news:
            news, intake.news = intake.news, []
            for text in news:
                self.complain(intake.timeline.now or 0, diagnostics.WARN, text)

    def on_time_jump(self, jump: Jump) -> None:
        """Time has jumped; a subclass with a state forgets it."""

    def more_counts(self) -> dict[str, int]:
        """Further counts for /diagnostics."""
        return {}

    def deadline(self) -> float | None:
        """When the node looks after itself, monotonic wall time in s."""
        return None if self._intake is None else self._watchdog.due

    def on_wake(self) -> None:
        """Take what nothing contradicts, and say what the node waits for if it is silent."""
        wall, intake = time.monotonic(), self._intake
        self._watchdog.due = wall + LOOK_S
        if intake is None:
            return
        with np.errstate(all="ignore"):
            self.guard(lambda: self._step_through(intake, intake.poll(wall)))
        level = self._watchdog.silent_level(wall)
        if level is not None:
            self.report(intake.timeline.now or 0, level, self._waiting(intake))

    def _waiting(self, intake: Intake) -> str:
        """What the node waits for, and what it has, with the topics' full names."""
        newest = intake.timeline.newest
        lacks = intake.gate.waiting()
        lacks += [t.name for t in self._inputs_of(intake) if t.name not in [*newest, *lacks]]
        parts = [self._lacking(name, newest.get(name)) for name in lacks]
        has = [
            f"{self._full_name(name)} to {1e-9 * stamp:.3f} s"
            for name, stamp in newest.items()
            if name not in lacks
        ]
        return f"waiting for {', '.join(parts)}{'; has ' if has else ''}{', '.join(has)}"

    def _inputs_of(self, intake: Intake) -> list[Topic]:
        return [topic for topic in self._receivers if topic.name in intake.gate.required]

    def _lacking(self, name: str, newest: int | None) -> str:
        full = self._full_name(name)
        state = "nothing yet" if newest is None else f"newest {1e-9 * newest:.3f} s"
        nobody = "" if self.count_publishers(full) else ", nobody publishes it"
        return f"{full} ({state}{nobody})"

    def _full_name(self, name: str) -> str:
        """The name of a topic on the graph, with namespace and remappings."""
        return next(sub.name for t, sub in self._receivers.items() if t.name == name)

    def offer(self, topic: Topic) -> None:
        """Be ready to `send` on a topic that is not among the outputs of the node's row."""
        self._senders[topic] = self._sender(topic)

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
            self.complain(stamp, diagnostics.ERROR, str(fault))

    def complain(self, stamp: int, level: int, text: str) -> None:
        """Log and report a fault, not more often than anybody can read."""
        log = self.get_logger()
        if level == diagnostics.ERROR:
            log.error(text, throttle_duration_sec=1.0)
        else:
            log.warning(text, throttle_duration_sec=1.0)
        wall = time.monotonic()
        if wall - self._complained >= COMPLAINTS_S or level != self._status.level:
            self._complained = wall
            self.report(stamp, level, text)

    def report(
        self, stamp: int, level: int = diagnostics.OK, message: str = "ok", **values: Any
    ) -> None:
        """Publish this node's state on /diagnostics."""
        self._told, name = self._counts(), self.get_name()
        self._status = Status(stamp, name, level, message, self._told | values, self.run_id)
        self._diagnostics(self._status)
        self._reported = stamp
        self._watchdog.said(time.monotonic())

    def _counts(self) -> dict[str, Any]:
        """What was counted so far, for /diagnostics."""
        counts = {"refused": self._refused, **self.more_counts()}
        return counts if self._intake is None else counts | self._intake.counts

    def report_each_second(
        self, stamp: int, level: int = diagnostics.OK, message: str = "ok", **values: Any
    ) -> None:
        """As `report`, at most once a second of simulation time."""
        if not 0 <= stamp - self._reported < DIAGNOSTICS_PERIOD:
            self.report(stamp, level, message, **values)

    def names_of(self, topic: Topic) -> tuple[str, ...]:
        """Names of the topic's values: of thrusters or of joints."""
        by_thruster = topic.signal in BY_THRUSTER
        return self.vehicle.thruster_names if by_thruster else self.vehicle.joint_names

    def missing_peers(self) -> list[str]:
        """What this node is still missing before a run can start, as text.

        Each of its endpoints must have matched every peer in the graph: messages published before
        that are lost.
        """
        lacks = []
        for topic, subscription in self._receivers.items():
            there, found = self.count_publishers(topic.name), subscription.get_publisher_count()
            if found < max(there, 0 if topic.is_occasional or topic in topics.COMPANIONS else 1):
                lacks.append(_lack(nobody_publishes(topic), there, found))
        for topic, publisher in self._outputs.items():
            there, found = self.count_subscribers(topic.name), publisher.get_subscription_count()
            if found < max(there, 1 if topic in self._needed else 0):
                lacks.append(_lack(nobody_reads(topic), there, found))
        return lacks

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
        newest = self._status
        if newest.stamp > 0 and self._counts() != self._told:
            # In a run: what it has counted since it last reported would be lost.
            self.report(newest.stamp, newest.level, newest.message)
        response.success, response.message = True, json.dumps(self._sent)
        return response


def _lack(nobody: str, there: int, found: int) -> str:
    """Nobody is there, or some are there that have not been found yet."""
    if not there:
        return nobody
    return f"{nobody.removeprefix('nobody ')}: {there - found} of {there} not found yet"
