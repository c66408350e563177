"""What all parts of the system must know of a kind of sensor."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from uvms_core.sensors.mounting import NO_AXES, Axes, Declared
from uvms_core.topic import SENSORS, Conversion, Topic
from uvms_core.vehicle.sensors import Sensor


def nothing(section: Sensor) -> Declared:
    """Messages carry the whole sample."""
    return ()


@dataclass(frozen=True)
class SensorType:
    """Name, section of the vehicle file, signal and message of a kind of sensor.

    Args:
        name: of its section in the vehicle file and of its entries in `uvms.sensors` and
            `uvms.measurements`.
        section: class of that section.
        signal: dataclass of one sample; its first field is `stamp` (int, ns), its arrays have the
            annotations of `uvms_core.signals`, by which they are checked.
        message: type of the message, such as `sensor_msgs/msg/Imu`.
        to_message: from topic, sample and names (which a sensor does not use) to a nested dict.
        from_message: from topic, message and names to a sample; raises SignalError.
        frame: of the message's header; empty: that in which the sensor is mounted.
        navigation: whether the navigation filter uses it, so that it needs a measurement.
        axes: which fields of a sample are along the sensor's axes. `from_message` leaves them as
            the driver published them; they are turned to the body's after it, as the vehicle file
            declares, and before `to_message`.
        declared: fields of a sample that messages do not carry, with their values, by its section.
        others: other types of message that a section may name in its field `message`.
    """

    name: str
    section: type[Sensor]
    signal: type
    message: str
    to_message: Callable[[Topic, Any, Sequence[str]], dict[str, Any]]
    from_message: Callable[[Topic, Any, Sequence[str]], Any]
    frame: str = ""
    navigation: bool = True
    axes: Axes = NO_AXES
    declared: Callable[[Any], Declared] = nothing
    others: tuple[tuple[str, Conversion], ...] = ()

    def conversion_of(self, message: str) -> Conversion:
        """To and from messages of a type, in the axes of the driver."""
        own = Conversion(self.to_message, self.from_message)
        return dict(self.others).get(message, own)

    @property
    def mounting_frame(self) -> str:
        """Frame at the sensor's own place, axes parallel to the body's."""
        return f"{self.name}_link_fsd"

    @property
    def topic(self) -> Topic:
        """Where its samples are published."""
        return Topic(
            f"{SENSORS}{self.name}",
            self.message,
            self.signal,
            self.frame or self.mounting_frame,
            conversion=Conversion(self.to_message, self.from_message),
            sensor=self.name,
        )
