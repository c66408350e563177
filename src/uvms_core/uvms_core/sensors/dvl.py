"""The Doppler velocity log: geometry_msgs/TwistWithCovarianceStamped."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.type import SensorType
from uvms_core.signals import DvlSample
from uvms_core.topic import Topic
from uvms_core.vehicle.sensors import Dvl

UNKNOWN = -1.0
"""Variance of what a sensor does not measure, as sensor_msgs has it for unknown covariances."""


def to_message(topic: Topic, sample: DvlSample, names: Sequence[str]) -> Plain:
    """geometry_msgs/TwistWithCovarianceStamped; the angular part is marked unknown."""
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = sample.covariance
    covariance[[3, 4, 5], [3, 4, 5]] = UNKNOWN
    twist = {"linear": parts.vector(sample.velocity), "angular": parts.vector(np.zeros(3))}
    return {
        "header": parts.header(topic, sample.stamp),
        "twist": {"twist": twist, "covariance": covariance.ravel()},
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> DvlSample:
    """From geometry_msgs/TwistWithCovarianceStamped; the angular part is not read."""
    fields.check_frame(topic, msg.header)
    return DvlSample(
        fields.stamp_of(msg.header.stamp),
        fields.vector(topic, "twist.twist.linear", msg.twist.twist.linear),
        fields.covariance(topic, "twist.covariance", msg.twist.covariance, 6)[:3, :3].copy(),
    )


TYPE = SensorType(
    "dvl", Dvl, DvlSample, "geometry_msgs/msg/TwistWithCovarianceStamped", to_message, from_message
)
