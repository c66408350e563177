"""The pressure sensor: sensor_msgs/FluidPressure."""

from collections.abc import Sequence
from typing import Any

from uvms_core.messages import fields, parts
from uvms_core.messages.parts import Plain
from uvms_core.sensors.type import SensorType
from uvms_core.signals import PressureSample
from uvms_core.topic import Topic
from uvms_core.vehicle.sensors import Pressure


def to_message(topic: Topic, sample: PressureSample, names: Sequence[str]) -> Plain:
    """sensor_msgs/FluidPressure."""
    return {
        "header": parts.header(topic, sample.stamp),
        "fluid_pressure": float(sample.pressure),
        "variance": float(sample.variance),
    }


def from_message(topic: Topic, msg: Any, names: Sequence[str]) -> PressureSample:
    """From sensor_msgs/FluidPressure."""
    fields.check_frame(topic, msg.header)
    return PressureSample(
        fields.stamp_of(msg.header.stamp),
        fields.number(topic, "fluid_pressure", msg.fluid_pressure),
        fields.number(topic, "variance", msg.variance),
    )


TYPE = SensorType(
    "pressure", Pressure, PressureSample, "sensor_msgs/msg/FluidPressure", to_message, from_message
)
