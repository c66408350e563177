"""Sensor samples to messages and back."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.messages import checks, parts
from uvms_core.messages.parts import Plain
from uvms_core.signals import Array, DvlSample, GpsSample, ImuSample, PressureSample
from uvms_core.topics import Topic

UNKNOWN = -1.0
"""Variance of what a sensor does not measure, as sensor_msgs has it for unknown covariances."""

STATUS_NO_FIX, STATUS_FIX = -1, 0
SERVICE_GPS = 1
COVARIANCE_KNOWN = 3

_SWAP = [1, 0, 2]
_SIGNS = np.outer((1.0, 1.0, -1.0), (1.0, 1.0, -1.0))


def swap_ned_enu(covariance: Array) -> Array:
    """A covariance between north-east-down and east-north-up; its own inverse, and exact."""
    return covariance[np.ix_(_SWAP, _SWAP)] * _SIGNS


def imu_to(topic: Topic, sample: ImuSample, names: Sequence[str]) -> Plain:
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


def imu_from(topic: Topic, msg: Any, names: Sequence[str]) -> ImuSample:
    """From sensor_msgs/Imu."""
    checks.check_frame(topic, msg.header)

    def covariance(field: str) -> Array:
        return checks.covariance(topic, field, getattr(msg, field), 3)

    return ImuSample(
        checks.stamp_of(msg.header.stamp),
        checks.quaternion(topic, "orientation", msg.orientation),
        checks.vector(topic, "angular_velocity", msg.angular_velocity),
        checks.vector(topic, "linear_acceleration", msg.linear_acceleration),
        covariance("orientation_covariance"),
        covariance("angular_velocity_covariance"),
        covariance("linear_acceleration_covariance"),
    )


def dvl_to(topic: Topic, sample: DvlSample, names: Sequence[str]) -> Plain:
    """geometry_msgs/TwistWithCovarianceStamped; the angular part is marked unknown."""
    covariance = np.zeros((6, 6))
    covariance[:3, :3] = sample.covariance
    covariance[[3, 4, 5], [3, 4, 5]] = UNKNOWN
    twist = {"linear": parts.vector(sample.velocity), "angular": parts.vector(np.zeros(3))}
    return {
        "header": parts.header(topic, sample.stamp),
        "twist": {"twist": twist, "covariance": covariance.ravel()},
    }


def dvl_from(topic: Topic, msg: Any, names: Sequence[str]) -> DvlSample:
    """From geometry_msgs/TwistWithCovarianceStamped; the angular part is not read."""
    checks.check_frame(topic, msg.header)
    return DvlSample(
        checks.stamp_of(msg.header.stamp),
        checks.vector(topic, "twist.twist.linear", msg.twist.twist.linear),
        checks.covariance(topic, "twist.covariance", msg.twist.covariance, 6)[:3, :3].copy(),
    )


def pressure_to(topic: Topic, sample: PressureSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/FluidPressure."""
    return {
        "header": parts.header(topic, sample.stamp),
        "fluid_pressure": float(sample.pressure),
        "variance": float(sample.variance),
    }


def pressure_from(topic: Topic, msg: Any, names: Sequence[str]) -> PressureSample:
    """From sensor_msgs/FluidPressure."""
    checks.check_frame(topic, msg.header)
    return PressureSample(
        checks.stamp_of(msg.header.stamp),
        checks.number(topic, "fluid_pressure", msg.fluid_pressure),
        checks.number(topic, "variance", msg.variance),
    )


def gps_to(topic: Topic, sample: GpsSample, names: Sequence[str]) -> Plain:
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


def gps_from(topic: Topic, msg: Any, names: Sequence[str]) -> GpsSample:
    """From sensor_msgs/NavSatFix; without a fix the position may be NaN."""
    checks.check_frame(topic, msg.header)
    fix = msg.status.status >= STATUS_FIX
    if fix:
        for field in ("latitude", "longitude", "altitude"):
            checks.number(topic, field, getattr(msg, field))
    covariance = checks.covariance(topic, "position_covariance", msg.position_covariance, 3)
    return GpsSample(
        checks.stamp_of(msg.header.stamp),
        fix,
        msg.latitude,
        msg.longitude,
        msg.altitude,
        swap_ned_enu(covariance),
    )
