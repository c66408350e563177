"""A magnetometer: sensor_msgs/MagneticField."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from pydantic import Field

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.mounting import Axes
from uvms_core.sensors.type import SensorType
from uvms_core.signals import Array, Array3
from uvms_core.topic import Topic
from uvms_core.vehicle.environment import Environment
from uvms_core.vehicle.further_sensors import Sensor

MICROTESLA = 1e-6
"""Tesla."""


class Magnetometer(Sensor):
    """A section of `sensors` in the vehicle file, of type magnetometer.

    The Earth's field at the site is in `environment.magnetic_field_ut`.
    """

    noise_ut: float = Field(gt=0.0, description="white noise along each axis, microtesla")
    bias_ut: float = Field(
        default=0.0,
        ge=0.0,
        description="std of what the vehicle's own iron and currents add along each axis,"
        " microtesla",
    )

    def check_site(self, site: Environment) -> None:
        """The heading follows from the horizontal part of the Earth's field."""
        if site.magnetic_field_ut is None or not any(site.magnetic_field_ut[:2]):
            raise ValueError(
                "a magnetometer needs environment.magnetic_field_ut, the Earth's field at the site"
                f" with a horizontal part; it is {site.magnetic_field_ut}"
            )


@dataclass(frozen=True)
class MagneticSample:
    """One magnetic field."""

    stamp: int  # ns
    field: Array3  # T, body axes
    covariance: Array  # (3, 3) T^2; zeros where it is not given


def to_message(topic: Topic, sample: MagneticSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/MagneticField."""
    return {
        "header": parts.header(topic, sample.stamp),
        "magnetic_field": parts.vector(sample.field),
        "magnetic_field_covariance": sample.covariance.ravel(),
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> MagneticSample:
    """From sensor_msgs/MagneticField."""
    fields.check_frame(topic, msg.header)
    path = "magnetic_field_covariance"
    return MagneticSample(
        fields.stamp_of(msg.header.stamp),
        fields.vector(topic, "magnetic_field", msg.magnetic_field),
        fields.stated_covariance(topic, path, msg.magnetic_field_covariance, 3),
    )


TYPE = SensorType(
    "magnetometer",
    Magnetometer,
    MagneticSample,
    "sensor_msgs/msg/MagneticField",
    to_message,
    from_message,
    axes=Axes(vectors=("field",), covariances=("covariance",)),
)
