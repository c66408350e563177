"""The navigation node on what drivers of sensors publish: best effort, with stamps of their own."""

import numpy as np
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.qos import qos_profile_sensor_data

from uvms_core import topics
from uvms_core.messages import to_message
from uvms_core.ros.convert import message_class, to_ros
from uvms_core.signals import ImuSample
from uvms_observer.nodes.navigation import NavigationNode

NONE = np.zeros((3, 3))
SINCE_1970 = 1_795_000_000_013_000_000
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


class Driver(Peer):
    """An IMU at rest at 97 Hz, best effort, with stamps since 1970, its quaternion rounded."""

    def __init__(self):
        super().__init__(heard=[topics.ODOMETRY])
        kind = message_class(topics.IMU)
        self.publisher = self.create_publisher(kind, topics.IMU.name, qos_profile_sensor_data)
        self.samples = 0

    def publish(self):
        stamp = SINCE_1970 + round(self.samples * 1e9 / 97.0)
        gravity = np.array([0.0, 0.0, -9.80665])
        sample = ImuSample(stamp, LEVEL, np.zeros(3), gravity, NONE, NONE, NONE)
        message = to_ros(message_class(topics.IMU), to_message(topics.IMU, sample, ()))
        message.orientation.w = 1.002  # rounded, as some drivers do
        self.publisher.publish(message)
        self.samples += 1

    @property
    def odometry(self):
        return self.heard[topics.ODOMETRY.name]


def navigation():
    return NavigationNode(parameter_overrides=parameters(pace="realtime"))


def test_a_best_effort_driver_off_the_grid_is_heard_and_answered_at_the_control_period():
    with graph_of(navigation, Driver) as (spinner, (_, driver)):

        def answered():
            driver.publish()
            return len(driver.odometry) >= 20

        spin_until(spinner, answered, rounds=600)
        stamps = np.array([odometry.stamp for odometry in driver.odometry])
        assert set(stamps % 50_000_000) == {0}
        assert stamps[0] > SINCE_1970
        np.testing.assert_allclose(driver.odometry[-1].quaternion, LEVEL, atol=1e-3)


def test_in_lockstep_a_best_effort_driver_is_named(capfd):
    def lockstep():
        return NavigationNode(parameter_overrides=parameters(pace="lockstep"))

    with graph_of(lockstep, Driver) as (spinner, _):
        spin_until(spinner, lambda: "it must be reliable" in capfd.readouterr().err, rounds=200)
