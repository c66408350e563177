"""The recorder's part in a lockstep run: it tells the plant up to where everything is recorded.

A recorder that lags behind by more than the history of a topic loses messages for good, reliable or
not. The plant therefore stays within a window of what has been acknowledged.
"""

import time
from collections.abc import Collection, Mapping

from rclpy.node import Node

from uvms_bringup.ros.recorder import Recorder
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.messages import to_message
from uvms_core.ros.convert import message_class
from uvms_core.ros.subscribe import qos_profile
from uvms_core.sensors import INERTIAL
from uvms_core.signals import to_seconds
from uvms_core.topic import NodeTopics, Qos, Topic
from uvms_core.vehicle import Vehicle

SHARE_OF_HISTORY = 0.25
"""Share of a topic's history that may be on its way: the window's, and as much again for what the
recorder holds back until its next acknowledgement, stay well within it."""
MOST_PERIODS = 40
"""Largest window: more gains no speed."""
ACKNOWLEDGEMENTS_A_WINDOW = 4
LOOK_S = 0.5
"""Wall time between two looks at a plant that does not go on."""
QUIET_LOOKS = 20
"""Looks in a row without any message after which what is missing will not come any more."""
TRUTH = (
    topics.APPLIED_THRUST,
    topics.TRUE_ODOMETRY,
    topics.TRUE_JOINT_STATES,
    topics.TRUE_DISTURBANCE,
)
EACH_TICK = (topics.CLOCK, *TRUTH, topics.JOINT_STATES)
"""What a plant publishes at every tick, beside the samples of the inertial unit."""


def window_for(vehicle: Vehicle, period: int) -> int:
    """Control periods that the plant may be ahead of the recorder; `period` in ns."""
    rates = [sensor.rate_hz for sensor in vehicle.sensors.mounted.values()]
    most = max(1.0, max(rates) * to_seconds(period))  # messages of a topic in a period
    return int(min(max(SHARE_OF_HISTORY * Qos().depth // most, 1), MOST_PERIODS))


class Acknowledgement:
    """Publishes on `recorded`.

    A stamp is complete when every topic of its tick has been recorded up to there. The plant says
    on `applied_thrust` which commands brought it to the stamp: where it used the nodes' own, these
    had all answered the tick before; where it timed out, nobody waits for what they did not send.

    Args:
        node: that publishes.
        recorder: of the run.
        graph: what each role reads and writes.
        foreign: roles of nodes that need not publish what nobody reads.
        further: topics that the run itself publishes at each tick.
        sampled: topics of the vehicle's sensors, `topics.sampled_topics(vehicle)`.
        period: control period, ns.
        window: of the plant, in control periods.
    """

    def __init__(
        self,
        node: Node,
        recorder: Recorder,
        graph: Mapping[str, NodeTopics],
        foreign: Collection[str],
        further: Collection[Topic],
        sampled: Mapping[str, Topic],
        period: int,
        window: int,
    ) -> None:
        self._recorder, self._newest = recorder, recorder.newest
        self.given_up: list[str] = []  # what was waited for in vain, in words
        self._sampled = sampled
        each_tick = (*EACH_TICK, sampled[INERTIAL.name])
        self._plants = [topic.name for topic in each_tick if _counts(topic, graph, foreign)]
        answers = [
            topic
            for role, own in graph.items()
            if role != topics.PLANT
            for topic in own.outputs
            if topic is not topics.REFERENCE
            and not topic.is_occasional
            and not (role in foreign and topic in topics.COMPANIONS)
            and _counts(topic, graph, foreign)
        ]
        self._answers = [topic.name for topic in (*answers, *further)]
        self._period = period
        self._step = period * max(window // ACKNOWLEDGEMENTS_A_WINDOW, 1)
        self._pending: int | None = None
        self._answered = False
        self._acknowledged = 0
        self._due, self._quiet, self._heard = 0.0, 0, 0
        self._wire, self._applied = codec(topics.RECORDED.type), codec(topics.APPLIED_THRUST.type)
        self._publisher = node.create_publisher(
            message_class(topics.RECORDED), topics.RECORDED.name, qos_profile(topics.RECORDED.qos)
        )
        recorder.receivers[topics.APPLIED_THRUST.name] = self._take_applied
        self._late: dict[str, int] = {}  # newest stamp that was sent, by topic
        self._gaps = codec(topics.SENSOR_GAPS.type)
        self._also_gaps = recorder.receivers.get(topics.SENSOR_GAPS.name, lambda data: None)
        recorder.receivers[topics.SENSOR_GAPS.name] = self._take_gaps
        recorder.on_message = self._look

    def _take_applied(self, data: bytes) -> None:
        stamp = self._newest[topics.APPLIED_THRUST.name]
        if stamp % self._step == 0:
            message = self._applied.decode(data)
            self._answered = not (message.thruster_safe or message.joint_safe)
            self._pending = stamp

    def _take_gaps(self, data: bytes) -> None:
        """Samples that are late or missing are not waited for."""
        message = self._gaps.decode(data)
        for sensor, newest in zip(message.sensors, message.newest, strict=True):
            self._late[self._sampled[sensor].name] = newest
        self._also_gaps(data)

    def _look(self) -> None:
        stamp = self._pending
        if stamp is None or not self._complete(stamp):
            return
        self._pending = None
        self._acknowledge(stamp)

    def look_after(self) -> None:
        """Called often: if all is quiet, say it again, and at last give up what is missing.

        An acknowledgement, and any message, is lost for good where this process was halted for
        longer than the middleware remembers it. The plant must not wait for ever; the counts at the
        end of the run tell what is missing.
        """
        now, heard = time.monotonic(), self._recorder.received.total()
        if now < self._due:
            return
        self._due = now + LOOK_S
        self._quiet = self._quiet + 1 if heard == self._heard else 0
        self._heard = heard
        if self._quiet and self._quiet % QUIET_LOOKS == 0 and self._pending is not None:
            self._give_up(self._pending)
        elif self._quiet:
            self._acknowledge(self._acknowledged)

    def _give_up(self, stamp: int) -> None:
        lacking = sorted(self._lacking(stamp))
        self.given_up.append(f"t = {to_seconds(stamp):.2f} s: never came: {', '.join(lacking)}")
        self._pending = None
        self._acknowledge(max(stamp, self._newest[topics.CLOCK.name]))

    def _acknowledge(self, stamp: int) -> None:
        self._acknowledged = stamp
        message = to_message(topics.RECORDED, stamp, ())
        self._publisher.publish(self._wire.encode(message))

    def _complete(self, stamp: int) -> bool:
        newest, before = self._newest, stamp - self._period
        return all(newest.get(name, -1) >= self._due_of(name, stamp) for name in self._plants) and (
            not self._answered or all(newest.get(name, -1) >= before for name in self._answers)
        )

    def _due_of(self, name: str, stamp: int) -> int:
        """The stamp up to which a topic of the plant has to be recorded."""
        return min(stamp, self._late.get(name, stamp)) if self._late else stamp

    def _lacking(self, stamp: int) -> set[str]:
        newest = self._newest
        lacking = {
            name for name in self._plants if newest.get(name, -1) < self._due_of(name, stamp)
        }
        if self._answered:
            before = stamp - self._period
            lacking |= {name for name in self._answers if newest.get(name, -1) < before}
        return lacking


def _counts(topic: Topic, graph: Mapping[str, NodeTopics], foreign: Collection[str]) -> bool:
    """Whether whoever writes it must do so at every tick."""
    writers = {role for role, own in graph.items() if topic in own.outputs}
    return not writers <= set(foreign) or bool(topics.readers(topic, graph) - set(foreign))
