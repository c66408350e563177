"""The service `navigation/reset` on a real graph: the filter starts anew where the next fix is."""

import numpy as np
from in_process import Peer, graph_of, parameters, spin_until
from rclpy.qos import qos_profile_sensor_data
from std_srvs.srv import Trigger

from uvms_core import topics
from uvms_core.diagnostics import ERROR
from uvms_core.geodesy import ned_to_geodetic
from uvms_core.messages import to_message
from uvms_core.ros.convert import message_class, to_ros
from uvms_core.signals import GpsSample, ImuSample, PressureSample
from uvms_core.vehicle import load_vehicle
from uvms_observer.nodes.navigation import NavigationNode

VEHICLE = load_vehicle()
NONE = np.zeros((3, 3))
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
PERIOD = 10_000_000
SINCE_1970 = 1_795_000_000_000_000_000
PLACE = np.array([120.0, -40.0, 0.0])
"""Where the receiver is; the filter was started elsewhere, and sure of it."""


class Surface(Peer):
    """A vehicle at rest at the surface; its receiver begins to work when it is told to."""

    def __init__(self):
        super().__init__(heard=[topics.ODOMETRY, topics.DIAGNOSTICS])
        self.senders = {
            topic: self.create_publisher(message_class(topic), topic.name, qos_profile_sensor_data)
            for topic in (topics.IMU, topics.PRESSURE, topics.GPS)
        }
        self.client = self.create_client(Trigger, "navigation/reset")
        self.has_fix, self.count = False, 0

    def send(self, topic, sample):
        message = to_ros(message_class(topic), to_message(topic, sample, ()))
        self.senders[topic].publish(message)

    def publish(self):
        stamp, sea = SINCE_1970 + self.count * PERIOD, VEHICLE.environment
        gravity = np.array([0.0, 0.0, -sea.gravity_m_s2])
        if self.count % 10 == 0:
            self.send(topics.PRESSURE, PressureSample(stamp, sea.atmospheric_pressure_pa, 1.0))
            if self.has_fix:
                datum = sea.datum_latitude_deg, sea.datum_longitude_deg
                place = ned_to_geodetic(PLACE, *datum)
                self.send(topics.GPS, GpsSample(stamp, True, *place, NONE))
        self.send(topics.IMU, ImuSample(stamp, LEVEL, np.zeros(3), gravity, NONE, NONE, NONE))
        self.count += 1

    @property
    def estimate(self):
        return self.heard[topics.ODOMETRY.name][-1]

    def said(self, text):
        return [s for s in self.heard[topics.DIAGNOSTICS.name] if text in s.message]


def navigation():
    return NavigationNode(parameter_overrides=parameters(pace="realtime"))


def test_after_a_reset_the_first_fix_decides():
    with graph_of(navigation, Surface) as (spinner, (_, vehicle)):

        def until(reached):
            def publish_and_look():
                vehicle.publish()
                return reached()

            spin_until(spinner, publish_and_look, rounds=1500)

        until(lambda: len(vehicle.heard[topics.ODOMETRY.name]) >= 20)
        before = vehicle.estimate
        assert np.linalg.norm(before.position[:2] - PLACE[:2]) > 100.0
        assert before.pose_covariance[0, 0] < 1.0
        answer = vehicle.client.call_async(Trigger.Request())
        until(answer.done)
        assert answer.result().success
        assert "reset on request" in answer.result().message
        until(lambda: vehicle.estimate.pose_covariance[0, 0] > 1e6)  # nothing is known now
        np.testing.assert_allclose(vehicle.estimate.position[:2], before.position[:2], atol=1.0)
        vehicle.has_fix = True
        until(lambda: vehicle.estimate.pose_covariance[0, 0] < 10.0)
        np.testing.assert_allclose(vehicle.estimate.position[:2], PLACE[:2], atol=2.0)
        until(lambda: vehicle.said("reset on request"))
        assert vehicle.said("reset on request")[0].level == ERROR
        told = len(vehicle.heard[topics.DIAGNOSTICS.name])
        until(lambda: any(s.level < ERROR for s in vehicle.heard[topics.DIAGNOSTICS.name][told:]))
