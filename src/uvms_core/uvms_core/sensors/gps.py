"""The satellite receiver: sensor_msgs/NavSatFix."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, GpsSample
from uvms_core.topic import Topic
from uvms_core.vehicle.sensors import Gps

STATUS_NO_FIX, STATUS_FIX = -1, 0
SERVICE_GPS = 1
COVARIANCE_UNKNOWN, COVARIANCE_KNOWN = 0, 3

_SWAP = [1, 0, 2]
_SIGNS = np.outer((1.0, 1.0, -1.0), (1.0, 1.0, -1.0))


def swap_ned_enu(covariance: Array) -> Array:
    """A covariance between north-east-down and east-north-up; its own inverse, and exact."""
    return covariance[np.ix_(_SWAP, _SWAP)] * _SIGNS


def to_message(topic: Topic, sample: GpsSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/NavSatFix, whose covariance is east-north-up."""
    return {
        "header": parts.header(topic, sample.stamp),
        "status": {
            "status": STATUS_FIX if sample.fix else STATUS_NO_FIX,
            "service": SERVICE_GPS,
        },
        "latitude": float(sample.latitude_deg),
        "longitude": float(sample.longitude_deg),
        "altitude": float(sample.altitude),
        "position_covariance": swap_ned_enu(sample.covariance).ravel(),
        "position_covariance_type": COVARIANCE_KNOWN,
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> GpsSample:
    """From sensor_msgs/NavSatFix; without a fix position and covariance may be NaN."""
    fields.check_frame(topic, msg.header)
    fix = msg.status.status >= STATUS_FIX
    if fix:
        for field in ("latitude", "longitude", "altitude"):
            fields.number(topic, field, getattr(msg, field))
    covariance, path = np.zeros((3, 3)), "position_covariance"
    is_stated = msg.position_covariance_type != COVARIANCE_UNKNOWN
    if is_stated and (fix or np.isfinite(msg.position_covariance).all()):
        covariance = fields.stated_covariance(topic, path, msg.position_covariance, 3)
    return GpsSample(
        fields.stamp_of(msg.header.stamp),
        fix,
        msg.latitude,
        msg.longitude,
        msg.altitude,
        swap_ned_enu(covariance),
    )


TYPE = SensorType("gps", Gps, GpsSample, "sensor_msgs/msg/NavSatFix", to_message, from_message)
