"""The sensors of a vehicle, each of some kind, under the name of its section."""

from dataclasses import dataclass
from functools import cached_property

from uvms_core.sensors.mounting import Mounting, mounting_of, turned
from uvms_core.sensors.type import SensorType
from uvms_core.topic import SENSORS, WORLD_FRAME, Topic
from uvms_core.vehicle.further_sensors import Sensor
from uvms_core.world_frames import MAP_FRAME


@dataclass(frozen=True)
class MountedSensor:
    """One sensor of a vehicle.

    Args:
        name: of its section in the vehicle file.
        type: kind of sensor.
        section: of the vehicle file, of class `type.section`.
    """

    name: str
    type: SensorType
    section: Sensor

    @property
    def navigation(self) -> bool:
        """Whether the navigation filter uses it."""
        return self.type.navigation

    @cached_property
    def mounting(self) -> Mounting:
        """How it is mounted, and in which axes its driver publishes."""
        return mounting_of(self.section)

    @property
    def mounting_frame(self) -> str:
        """Frame at the sensor's own place; its axes are those in which its data are."""
        declared = self.section.frame_id if not self.type.frame else None
        return declared or f"{self.name}_link{'' if self.mounting.axes == 'flu' else '_fsd'}"

    @property
    def frame(self) -> str:
        """`frame_id` of its messages."""
        if self.section.frame_id is not None:
            return self.section.frame_id
        if self.type.frame == WORLD_FRAME and self.mounting.world == "enu":
            return MAP_FRAME
        # two of a kind have frames of their own
        return self.type.frame.replace(self.type.name, self.name) or self.mounting_frame

    @cached_property
    def topic(self) -> Topic:
        """Where its samples are published, and how they are converted."""
        kind = self.type
        message = getattr(self.section, "message", kind.message)
        declared = kind.declared(self.section)
        inner = kind.conversion_of(message)
        return Topic(
            self.section.topic or f"{SENSORS}{self.name}",
            message,
            kind.signal,
            self.frame,
            conversion=turned(inner, self.mounting, kind.axes, declared),
            is_enu=self.mounting.world == "enu",
            sensor=self.name,
        )
