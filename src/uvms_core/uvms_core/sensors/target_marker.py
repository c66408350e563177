"""A marker on the work object seen by a camera: geometry_msgs/PoseWithCovarianceStamped."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from pydantic import Field, model_validator

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, Array3, Quaternion
from uvms_core.start import Coordinate
from uvms_core.topic import Topic
from uvms_core.vehicle.further_sensors import Sensor
from uvms_core.vehicle.parts import Vector3

OPTICAL_FRAME = "target_marker_optical"
"""Of the messages, as REP-103 has it for cameras: x right, y down, z along the view."""
R_MOUNT_OPTICAL = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
"""The view is along x of the mount, to the right is starboard, down is down."""


class TargetMarker(Sensor):
    """Section `sensors.target_marker` of the vehicle file, which may be left out.

    With `rpy_deg` of (0, 0, 0) the camera looks forward, with (0, -90, 0) down. The marker lies in
    the x-y plane of its own frame; z points out of its face.
    """

    field_of_view_deg: tuple[float, float] = Field(
        default=(60.0, 45.0), description="of the image, from side to side and top to bottom, deg"
    )
    min_range_m: float = Field(default=0.0, ge=0.0, description="nearer it is not recognised, m")
    max_range_m: float = Field(gt=0.0, description="farther away it is not recognised, m")
    max_view_angle_deg: float = Field(
        default=75.0,
        gt=0.0,
        lt=90.0,
        description="between the normal of the marker and the line to the camera: beyond it the"
        " marker is not recognised, deg",
    )
    noise_m: float = Field(gt=0.0, description="white noise of the marker's place, m")
    noise_m_per_m: float = Field(
        default=0.0, ge=0.0, description="and this for each metre of its range, m"
    )
    angle_noise_deg: float = Field(
        gt=0.0, description="white noise of the marker's attitude about each axis, deg"
    )
    target_position_m: tuple[Coordinate, Coordinate, Coordinate] = Field(
        description="place of the marker in map_ned, m"
    )
    target_rpy_deg: Vector3 = Field(
        default=(180.0, 0.0, 0.0),
        description="attitude of the marker in map_ned, deg; (180, 0, 0) faces up",
    )
    target_std_m: float | None = Field(
        default=None,
        ge=0.0,
        description="how well navigation knows that place, std along each axis, m; none: not at"
        " all, so that it takes the place from the first sight",
    )
    target_std_deg: float = Field(
        default=0.0, ge=0.0, description="and that attitude, std about each axis, deg"
    )

    @model_validator(mode="after")
    def _can_be_seen(self) -> "TargetMarker":
        if self.max_range_m <= self.min_range_m:
            raise ValueError(
                f"max_range_m = {self.max_range_m:g} m must be above min_range_m ="
                f" {self.min_range_m:g} m"
            )
        if not all(0.0 < angle < 180.0 for angle in self.field_of_view_deg):
            raise ValueError(
                f"field_of_view_deg = {list(self.field_of_view_deg)} must lie between 0 and 180"
            )
        return self

    @property
    def sensor_axes(self) -> Array:
        """Axes of `OPTICAL_FRAME` in the body frame, (3, 3)."""
        mount = quat_to_matrix(rpy_to_quat(*np.radians(self.rpy_deg)))
        found: Array = mount @ R_MOUNT_OPTICAL
        return found

    def recognises(self, seen: Array, normal: Array) -> bool:
        """Whether a marker at this place (3,) with this normal (3,), camera axes, is recognised."""
        away = float(np.linalg.norm(seen))
        if seen[2] <= 0.0 or not self.min_range_m <= away <= self.max_range_m:
            return False
        half_view = np.tan(np.radians(self.field_of_view_deg) / 2.0)
        if (np.abs(seen[:2]) > half_view * seen[2]).any():
            return False
        least_facing = np.cos(np.radians(self.max_view_angle_deg))
        return bool(-normal.dot(seen) >= least_facing * away)

    @property
    def target_quaternion(self) -> Array:
        """Attitude of the marker in map_ned, (4,)."""
        found: Array = rpy_to_quat(*np.radians(self.target_rpy_deg))
        return found


@dataclass(frozen=True)
class MarkerSample:
    """The marker as the camera sees it, in `OPTICAL_FRAME`."""

    stamp: int  # ns
    position: Array3  # m, of the marker
    quaternion: Quaternion  # marker to camera
    covariance: (
        Array  # (6, 6) m^2 and rad^2, place and turn about the camera's axes; zeros: unknown
    )


def to_message(topic: Topic, sample: MarkerSample, names: Sequence[str]) -> Plain:
    """geometry_msgs/PoseWithCovarianceStamped in the camera's frame."""
    pose = {
        "position": parts.vector(sample.position),
        "orientation": parts.quaternion(sample.quaternion),
    }
    return {
        "header": parts.header(topic, sample.stamp),
        "pose": {"pose": pose, "covariance": sample.covariance.ravel()},
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> MarkerSample:
    """From geometry_msgs/PoseWithCovarianceStamped in the camera's frame."""
    fields.check_frame(topic, msg.header)
    return MarkerSample(
        fields.stamp_of(msg.header.stamp),
        fields.vector(topic, "pose.pose.position", msg.pose.pose.position),
        fields.rounded_quaternion(topic, "pose.pose.orientation", msg.pose.pose.orientation),
        fields.covariance(topic, "pose.covariance", msg.pose.covariance, 6),
    )


TYPE = SensorType(
    "target_marker",
    TargetMarker,
    MarkerSample,
    "geometry_msgs/msg/PoseWithCovarianceStamped",
    to_message,
    from_message,
    frame=OPTICAL_FRAME,
)
