"""A heading, of a compass, a dual-antenna receiver or another attitude sensor: sensor_msgs/Imu.

Of its message the heading of the orientation is read alone. ROS has no message of a heading alone;
an orientation in sensor_msgs/Imu is what drivers publish (REP-145) and what robot_localization
reads a heading from, and its covariance says how good it is.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.mounting import Axes
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, Quaternion
from uvms_core.topic import Topic
from uvms_core.vehicle.further_sensors import WorldSensor


class Heading(WorldSensor):
    """A section of `sensors` in the vehicle file, of type heading."""

    noise_deg: float = Field(gt=0.0, description="white noise of the heading, deg")
    bias_deg: float = Field(
        default=0.0, ge=0.0, description="std of its constant bias, such as deviation, deg"
    )


@dataclass(frozen=True)
class HeadingSample:
    """One attitude, of which the heading counts."""

    stamp: int  # ns
    quaternion: Quaternion  # body to map_ned
    covariance: Array  # (3, 3) rad^2, about the body axes; zeros where it is not given


def to_message(topic: Topic, sample: HeadingSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/Imu, whose rates and accelerations are marked unknown."""
    unknown = np.array([fields.UNKNOWN, *[0.0] * 8])
    return {
        "header": parts.header(topic, sample.stamp),
        "orientation": parts.quaternion(sample.quaternion),
        "orientation_covariance": sample.covariance.ravel(),
        "angular_velocity": parts.vector(np.zeros(3)),
        "angular_velocity_covariance": unknown,
        "linear_acceleration": parts.vector(np.zeros(3)),
        "linear_acceleration_covariance": unknown,
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> HeadingSample:
    """From sensor_msgs/Imu; its rates and accelerations are not read."""
    fields.check_frame(topic, msg.header)
    path = "orientation_covariance"
    if msg.orientation_covariance[0] == fields.UNKNOWN:
        raise SignalError(f"{topic.name}: {path}[0] is -1: no orientation, and so no heading")
    return HeadingSample(
        fields.stamp_of(msg.header.stamp),
        fields.rounded_quaternion(topic, "orientation", msg.orientation),
        fields.covariance(topic, path, msg.orientation_covariance, 3),
    )


TYPE = SensorType(
    "heading",
    Heading,
    HeadingSample,
    "sensor_msgs/msg/Imu",
    to_message,
    from_message,
    axes=Axes(covariances=("covariance",), attitudes=("quaternion",)),
)
