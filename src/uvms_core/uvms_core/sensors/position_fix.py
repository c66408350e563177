"""A position fix under water, of USBL, LBL or a marker: geometry_msgs/PoseWithCovarianceStamped."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field, model_validator

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, Array3
from uvms_core.start import Coordinate
from uvms_core.topic import WORLD_FRAME, Topic
from uvms_core.vehicle.further_sensors import WorldSensor

UNKNOWN = -1.0
"""Variance of the attitude, which such a sensor does not measure."""


class PositionFix(WorldSensor):
    """Section `sensors.position_fix` of the vehicle file, which may be left out."""

    noise_m: float = Field(gt=0.0, description="white noise north and east, m")
    vertical_noise_m: float | None = Field(
        default=None, gt=0.0, description="white noise of the depth, m; none: as noise_m"
    )
    source_m: tuple[Coordinate, Coordinate, Coordinate] | None = Field(
        default=None, description="place of the marker or transponder in map_ned, m"
    )
    max_range_m: float | None = Field(
        default=None, gt=0.0, description="no fix farther from it than this, m; none: always a fix"
    )

    @model_validator(mode="after")
    def _range_of_something(self) -> "PositionFix":
        if self.max_range_m is not None and self.source_m is None:
            raise ValueError("max_range_m needs source_m, the place from which it counts")
        return self


@dataclass(frozen=True)
class FixSample:
    """One fix."""

    stamp: int  # ns
    position: Array3  # m, of the sensor in map_ned
    covariance: Array  # (3, 3) m^2, map_ned axes; zeros where it is not given


def to_message(topic: Topic, sample: FixSample, names: Sequence[str]) -> Plain:
    """geometry_msgs/PoseWithCovarianceStamped; the attitude is marked unknown."""
    R = fields.from_map_ned(topic)
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = R @ sample.covariance @ R.T
    covariance[[3, 4, 5], [3, 4, 5]] = UNKNOWN
    level = np.array([0.0, 0.0, 0.0, 1.0])
    pose = {"position": parts.vector(R @ sample.position), "orientation": parts.quaternion(level)}
    return {
        "header": parts.header(topic, sample.stamp),
        "pose": {"pose": pose, "covariance": covariance.ravel()},
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> FixSample:
    """From geometry_msgs/PoseWithCovarianceStamped in map_ned, or in map (east, north, up)."""
    position = fields.vector(topic, "pose.pose.position", msg.pose.pose.position)
    covariance = fields.covariance(topic, "pose.covariance", msg.pose.covariance, 6)[:3, :3]
    R = fields.to_map_ned(topic, msg.header)
    return FixSample(fields.stamp_of(msg.header.stamp), R @ position, R @ covariance @ R.T)


TYPE = SensorType(
    "position_fix",
    PositionFix,
    FixSample,
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    to_message,
    from_message,
    frame=WORLD_FRAME,
)
