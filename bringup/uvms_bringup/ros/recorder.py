"""Records every topic of a run as it is on the wire: raw CDR, stamped with simulation time."""

from collections.abc import Callable
from struct import unpack_from

from rclpy.node import Node

from uvms_bringup.log.schema import qos_yaml
from uvms_dynamics import topics
from uvms_dynamics.ros.convert import message_class
from uvms_dynamics.ros.node import qos_profile
from uvms_dynamics.signals import NANOSECONDS
from uvms_dynamics.topics import Topic

Write = Callable[[str, str, str, int, bytes], None]

UNSTAMPED = {topics.TF.name, topics.TF_STATIC.name, topics.ROBOT_DESCRIPTION.name}


class Recorder:
    """Subscribes to all topics of the table.

    The hidden topics of the planner's actions are left out: they hold random goal ids, so that no
    two runs were alike, and mcap_ros2 refuses the name of a feedback's type. What a feedback says
    stands in the planner's diagnostics, too.

    Args:
        node: whose subscriptions these are.
        write: takes (topic, type, qos in YAML, stamp in ns, CDR bytes), as `LogWriter.write`.
    """

    def __init__(self, node: Node, write: Write) -> None:
        self._write = write
        self.stamp = 0
        self.on_clock: Callable[[], None] = lambda: None
        self.newest: dict[str, int] = {}
        for topic in topics.ALL:
            self._subscribe(node, topic)

    def _subscribe(self, node: Node, topic: Topic) -> None:
        name = topic.resolve(node.get_namespace())
        qos = qos_yaml(topic.qos)
        stamped = topic.name not in UNSTAMPED

        def receive(data: bytes) -> None:
            stamp = stamp_of(data) if stamped else self.stamp
            if topic is topics.CLOCK:
                self.stamp = stamp
                self.on_clock()
            self.newest[topic.name] = stamp
            self._write(name, topic.type, qos, stamp, data)

        node.create_subscription(
            message_class(topic), topic.name, receive, qos_profile(topic.qos), raw=True
        )


def stamp_of(data: bytes) -> int:
    """Stamp in ns of a message that begins with a header or a time, from its CDR bytes."""
    seconds, nanoseconds = unpack_from("<iI" if data[1] & 1 else ">iI", data, 4)
    return seconds * NANOSECONDS + nanoseconds
