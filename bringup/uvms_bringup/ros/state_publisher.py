"""Node `state_publisher`: robot_description, /tf_static and /tf for viewers such as RViz.

Every `uvms run` has it inside its conductor; start this one for a graph that is started by hand.
"""

from collections.abc import Callable
from typing import Any

from rclpy.node import Node
from rclpy.publisher import Publisher

from uvms_core import topics
from uvms_core.cdr import Codec, codec
from uvms_core.description import StateFrames, description_message, static_message
from uvms_core.errors import UvmsError
from uvms_core.messages import from_message
from uvms_core.ros.convert import message_class
from uvms_core.ros.main import main_of
from uvms_core.ros.node import NodeConfig
from uvms_core.ros.parameters import declare_config
from uvms_core.ros.subscribe import qos_profile
from uvms_core.tick_gate import Delayed, Same, Tick, TickGate
from uvms_core.topics import Topic
from uvms_core.vehicle import Vehicle, load_vehicle

SOURCES = (topics.ODOMETRY, topics.JOINT_STATES)
"""What /tf is made from."""


class StateBroadcaster:
    """Publishes the vehicle's description once and its transforms for every odometry.

    Args:
        node: whose publishers these are.
        lockstep: wait for the joint states of the odometry's own stamp, or for those that have
            come by it where the plant says that they are late; else take the newest.
    """

    def __init__(self, node: Node, vehicle: Vehicle, lockstep: bool) -> None:
        self._logger = node.get_logger()
        self._frames = StateFrames(vehicle)
        inputs = {topics.ODOMETRY.name: Same(), topics.JOINT_STATES.name: Delayed()}
        self._gate = TickGate(inputs, topics.ODOMETRY.name, lockstep, in_loop=False)
        self.receivers = {topic.name: self._receiver(topic, vehicle) for topic in SOURCES}
        self.receivers[topics.SENSOR_GAPS.name] = self._take_gaps(codec(topics.SENSOR_GAPS.type))
        self._wire = codec(topics.TF.type)
        self._moving = _publisher(node, topics.TF)
        self._fixed = [
            _publish_once(node, topics.ROBOT_DESCRIPTION, description_message(vehicle)),
            _publish_once(node, topics.TF_STATIC, static_message(vehicle)),
        ]

    def _receiver(self, topic: Topic, vehicle: Vehicle) -> Callable[[bytes], None]:
        """Callback for the bytes of a source; a refused message yields no transforms."""
        names, wire = vehicle.joint_names, codec(topic.type)

        def receive(data: bytes) -> None:
            try:
                signal = from_message(topic, wire.decode(data), names)
            except UvmsError as fault:
                self._logger.error(str(fault), throttle_duration_sec=1.0)
                return
            for tick in self._gate.push(topic.name, signal.stamp, signal):
                self._publish(tick)

        return receive

    def _take_gaps(self, wire: Codec) -> Callable[[bytes], None]:
        """Callback for what the plant says is late."""

        def receive(data: bytes) -> None:
            gaps = from_message(topics.SENSOR_GAPS, wire.decode(data), ())
            late = dict(zip(gaps.sensors, gaps.newest, strict=True))
            if topics.ENCODERS in late:
                newest = {topics.JOINT_STATES.name: late[topics.ENCODERS]}
                for tick in self._gate.skip(gaps.stamp, newest):
                    self._publish(tick)

        return receive

    def _publish(self, tick: Tick) -> None:
        odometry, joints = (tick[topic.name] for topic in SOURCES)
        self._moving.publish(self._wire.encode(self._frames.message(odometry, joints)))


class StatePublisherNode(Node):
    """odometry and joint_states in; robot_description, /tf_static and /tf out."""

    def __init__(self, **options: Any) -> None:
        super().__init__("state_publisher", **options)
        config = declare_config(self, NodeConfig)
        vehicle = load_vehicle(config.vehicle_file or None)
        states = StateBroadcaster(self, vehicle, config.pace == "lockstep")
        for topic in (*SOURCES, topics.SENSOR_GAPS):
            receive, qos = states.receivers[topic.name], qos_profile(topic.qos)
            self.create_subscription(message_class(topic), topic.name, receive, qos, raw=True)


def _publisher(node: Node, topic: Topic) -> Publisher:
    return node.create_publisher(message_class(topic), topic.name, qos_profile(topic.qos))


def _publish_once(node: Node, topic: Topic, message: dict[str, Any]) -> Publisher:
    publisher = _publisher(node, topic)
    publisher.publish(codec(topic.type).encode(message))
    return publisher


def main(args: list[str] | None = None) -> int:
    """`ros2 run uvms_bringup state_publisher`."""
    return main_of(StatePublisherNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
