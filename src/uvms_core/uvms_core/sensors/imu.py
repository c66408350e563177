"""The gyrocompass with its inertial unit: sensor_msgs/Imu."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.mounting import Axes, Declared
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, ImuSample
from uvms_core.topic import Topic
from uvms_core.vehicle.sensors import Imu

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
LEVEL.flags.writeable = False  # files with numba kernels take it
"""Attitude of a sample without one."""


def to_message(topic: Topic, sample: ImuSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/Imu; an attitude that was not measured is marked so."""
    orientation_covariance = sample.orientation_covariance.ravel()
    if not sample.oriented:
        orientation_covariance = np.array([fields.UNKNOWN, *[0.0] * 8])
    return {
        "header": parts.header(topic, sample.stamp),
        "orientation": parts.quaternion(sample.quaternion),
        "orientation_covariance": orientation_covariance,
        "angular_velocity": parts.vector(sample.angular_velocity),
        "angular_velocity_covariance": sample.angular_velocity_covariance.ravel(),
        "linear_acceleration": parts.vector(sample.linear_acceleration),
        "linear_acceleration_covariance": sample.linear_acceleration_covariance.ravel(),
    }


def declared(section: Imu) -> Declared:
    """An attitude that the vehicle file says is none is not used, whatever messages say."""
    return () if section.orientation else (("oriented", False),)


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> ImuSample:
    """From sensor_msgs/Imu, which needs rates and accelerations; the attitude may be missing.

    Raises:
        SignalError: one of them is marked as not measured, or is not finite.
    """
    fields.check_frame(topic, msg.header)
    for field in ("angular_velocity", "linear_acceleration"):
        if getattr(msg, f"{field}_covariance")[0] == fields.UNKNOWN:
            raise SignalError(
                f"{topic.name}: {field}_covariance[0] is -1: not measured; an inertial unit must"
                " measure it"
            )
    oriented = msg.orientation_covariance[0] != fields.UNKNOWN

    def covariance(field: str) -> Array:
        return fields.stated_covariance(topic, field, getattr(msg, field), 3)

    return ImuSample(
        fields.stamp_of(msg.header.stamp),
        fields.rounded_quaternion(topic, "orientation", msg.orientation)
        if oriented
        else LEVEL.copy(),
        fields.vector(topic, "angular_velocity", msg.angular_velocity),
        fields.vector(topic, "linear_acceleration", msg.linear_acceleration),
        covariance("orientation_covariance") if oriented else np.zeros((3, 3)),
        covariance("angular_velocity_covariance"),
        covariance("linear_acceleration_covariance"),
        oriented,
    )


TYPE = SensorType(
    "imu",
    Imu,
    ImuSample,
    "sensor_msgs/msg/Imu",
    to_message,
    from_message,
    declared=declared,
    axes=Axes(
        vectors=("angular_velocity", "linear_acceleration"),
        covariances=(
            "orientation_covariance",
            "angular_velocity_covariance",
            "linear_acceleration_covariance",
        ),
        attitudes=("quaternion",),
    ),
)
