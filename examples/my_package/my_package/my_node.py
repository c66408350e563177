"""A controller node on plain rclpy: nothing of it but topic names and signals is from UVMS.

It takes the place of the node `controller` and answers every odometry message, when joint states
and a reference for the same stamp are there, with one wrench and one joint command of that stamp.
"""

from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy

from my_package.my_law import MyLaw
from uvms_control import ControlConfig
from uvms_core import topics
from uvms_core.messages import from_message, to_message
from uvms_core.ros.convert import message_class, to_ros
from uvms_core.tick_gate import Covering, Same, TickGate
from uvms_core.vehicle import load_vehicle

INPUTS = (topics.ODOMETRY, topics.JOINT_STATES, topics.REFERENCE)
OUTPUTS = (topics.WRENCH_COMMAND, topics.JOINT_COMMAND)
QOS = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)
"""Deep enough that in lockstep, faster than real time, no message is lost."""


class MyController(Node):
    """odometry, joint_states and reference in; wrench_command and joint_command out."""

    def __init__(self, **options: Any) -> None:
        super().__init__("controller", **options)
        file = self.declare_parameter("vehicle_file", "").value
        bandwidth = self.declare_parameter("bandwidth", 1.2).value
        vehicle = load_vehicle(file or None)
        self._joint_names = vehicle.joint_names
        config = ControlConfig(law="my_package.my_law:MyLaw", parameters={"bandwidth": bandwidth})
        self._law = MyLaw(vehicle, config.resolved())
        self._gate = TickGate(
            {"odometry": Same(), "joint_states": Same(), "reference": Covering()},
            trigger="odometry",
            lockstep=True,
        )
        self._senders = {t: self.create_publisher(message_class(t), t.name, QOS) for t in OUTPUTS}
        for topic in INPUTS:
            self._subscribe(topic)

    def _subscribe(self, topic: topics.Topic) -> None:
        def receive(message: Any) -> None:
            signal = from_message(topic, message, self._joint_names)
            for tick in self._gate.push(topic.name, signal.stamp, signal):
                self._step(tick["odometry"], tick["joint_states"], tick["reference"])

        self.create_subscription(message_class(topic), topic.name, receive, QOS)

    def _step(self, odometry: Any, joints: Any, reference: Any) -> None:
        commands = self._law.step(odometry, joints, None, reference)
        for topic, signal in zip(OUTPUTS, commands, strict=True):
            fields = to_message(topic, signal, self._joint_names)
            self._senders[topic].publish(to_ros(message_class(topic), fields))


def main() -> None:
    """Start the node."""
    rclpy.init()
    rclpy.spin(MyController())


if __name__ == "__main__":
    main()
