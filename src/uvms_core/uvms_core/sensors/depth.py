"""A depth gauge that gives metres: geometry_msgs/PoseWithCovarianceStamped, of which z is read.

ROS has no message of a depth. Drivers that turn pressure into metres publish a pose with z and its
variance, which is also what robot_localization takes, in map (z up) or map_ned (z down).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.type import SensorType
from uvms_core.topic import WORLD_FRAME, Topic
from uvms_core.vehicle.further_sensors import WorldSensor

_Z = (2, 2)
_LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


class Depth(WorldSensor):
    """A section of `sensors` in the vehicle file, of type depth."""

    noise_m: float = Field(gt=0.0, description="white noise, m")
    bias_m: float = Field(default=0.0, ge=0.0, description="std of the constant bias, m")


@dataclass(frozen=True)
class DepthSample:
    """One depth."""

    stamp: int  # ns
    depth: float  # m below the surface, of the sensor
    variance: float  # m^2; 0 where it is not given


def to_message(topic: Topic, sample: DepthSample, names: Sequence[str]) -> Plain:
    """geometry_msgs/PoseWithCovarianceStamped; all but z is marked unknown."""
    covariance = np.diag([fields.UNKNOWN] * 6)
    covariance[_Z] = sample.variance
    place = fields.from_map_ned(topic) @ np.array([0.0, 0.0, sample.depth])
    pose = {"position": parts.vector(place), "orientation": parts.quaternion(_LEVEL)}
    return {
        "header": parts.header(topic, sample.stamp),
        "pose": {"pose": pose, "covariance": covariance.ravel()},
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> DepthSample:
    """From geometry_msgs/PoseWithCovarianceStamped in a frame of the world; z alone is read."""
    down = fields.to_map_ned(topic, msg.header)[_Z]
    covariance = fields.covariance(topic, "pose.covariance", msg.pose.covariance, 6)
    return DepthSample(
        fields.stamp_of(msg.header.stamp),
        float(down * fields.number(topic, "pose.pose.position.z", msg.pose.pose.position.z)),
        max(float(covariance[_Z]), 0.0),
    )


TYPE = SensorType(
    "depth",
    Depth,
    DepthSample,
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    to_message,
    from_message,
    frame=WORLD_FRAME,
)
