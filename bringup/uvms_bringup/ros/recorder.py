"""Records every topic of a run as raw CDR, stamped with simulation time."""

from collections import Counter
from collections.abc import Callable, Sequence
from struct import unpack_from

from rclpy.node import Node

from uvms_analysis.log.schema import qos_yaml
from uvms_core import topics
from uvms_core.ros.convert import message_class
from uvms_core.ros.subscribe import qos_profile
from uvms_core.signals import NANOSECONDS
from uvms_core.topics import Topic

Write = Callable[[str, str, str, int, bytes], None]

UNSTAMPED = {topics.TF_STATIC.name, topics.ROBOT_DESCRIPTION.name, topics.ROSOUT.name}
"""Without a stamp, or with one of wall time: they get the newest simulation time."""
COUNT_SIZE = 4
"""A message that is a sequence alone, as /tf, begins with its length."""


class Recorder:
    """Subscribes to all topics of a run.

    The hidden topics of the planner's actions are left out: they hold random goal ids, so that no
    two runs were alike, and mcap_ros2 refuses the name of a feedback's type. What a feedback says
    stands in the planner's diagnostics, too.

    Args:
        node: whose subscriptions these are.
        recorded: the run's topics, `topics.of(vehicle)`.
        write: takes (topic, type, qos in YAML, stamp in ns, CDR bytes), as `LogWriter.write`.
    """

    def __init__(self, node: Node, write: Write, recorded: Sequence[Topic] = topics.ALL) -> None:
        self._write = write
        self.stamp = 0
        self.set_back: tuple[int, int] | None = None  # stamps, where /clock went back
        self.on_clock: Callable[[], None] = lambda: None
        self.on_message: Callable[[], None] = lambda: None
        self.newest: dict[str, int] = {}  # stamp by topic's name
        self.received: Counter[str] = Counter()  # messages by topic's name
        self.receivers: dict[str, Callable[[bytes], None]] = {}  # further consumers
        for topic in recorded:
            self._subscribe(node, topic)

    def _subscribe(self, node: Node, topic: Topic) -> None:
        name = topic.resolve(node.get_namespace())
        qos = qos_yaml(topic.qos)
        stamped, offset = topic.name not in UNSTAMPED, COUNT_SIZE * (topic is topics.TF)

        def receive(data: bytes) -> None:
            stamp = stamp_of(data, offset) if stamped else self.stamp
            if topic is topics.CLOCK:
                self._take_time(stamp)
            self.newest[topic.name] = stamp
            self.received[topic.name] += 1
            self._write(name, topic.type, qos, stamp, data)
            if topic.name in self.receivers:
                self.receivers[topic.name](data)
            self.on_message()

        node.create_subscription(
            message_class(topic), topic.name, receive, qos_profile(topic.qos), raw=True
        )

    def _take_time(self, stamp: int) -> None:
        if stamp < self.stamp:
            self.set_back = self.set_back or (self.stamp, stamp)
        self.stamp = stamp
        self.on_clock()


def stamp_of(data: bytes, offset: int = 0) -> int:
    """Stamp in ns of a message that has a header or a time at `offset`, from its CDR bytes."""
    seconds, nanoseconds = unpack_from("<iI" if data[1] & 1 else ">iI", data, 4 + offset)
    return seconds * NANOSECONDS + nanoseconds
