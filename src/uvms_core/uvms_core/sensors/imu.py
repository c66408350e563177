"""The gyrocompass with its inertial unit: sensor_msgs/Imu."""

from collections.abc import Sequence
from typing import Any

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, ImuSample
from uvms_core.topic import Topic
from uvms_core.vehicle.sensors import Imu


def to_message(topic: Topic, sample: ImuSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/Imu."""
    return {
        "header": parts.header(topic, sample.stamp),
        "orientation": parts.quaternion(sample.quaternion),
        "orientation_covariance": sample.orientation_covariance.ravel(),
        "angular_velocity": parts.vector(sample.angular_velocity),
        "angular_velocity_covariance": sample.angular_velocity_covariance.ravel(),
        "linear_acceleration": parts.vector(sample.linear_acceleration),
        "linear_acceleration_covariance": sample.linear_acceleration_covariance.ravel(),
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> ImuSample:
    """From sensor_msgs/Imu."""
    fields.check_frame(topic, msg.header)

    def covariance(field: str) -> Array:
        return fields.covariance(topic, field, getattr(msg, field), 3)

    return ImuSample(
        fields.stamp_of(msg.header.stamp),
        fields.rounded_quaternion(topic, "orientation", msg.orientation),
        fields.vector(topic, "angular_velocity", msg.angular_velocity),
        fields.vector(topic, "linear_acceleration", msg.linear_acceleration),
        covariance("orientation_covariance"),
        covariance("angular_velocity_covariance"),
        covariance("linear_acceleration_covariance"),
    )


TYPE = SensorType("imu", Imu, ImuSample, "sensor_msgs/msg/Imu", to_message, from_message)
