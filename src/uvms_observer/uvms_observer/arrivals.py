"""How the samples of a vehicle's sensors, and its thrusts, come to navigation."""

from collections.abc import Iterator

from uvms_core import topics
from uvms_core.sensors import MountedSensor, mounted_sensors
from uvms_core.signals import to_nanoseconds
from uvms_core.tick_gate import CompanionBefore, Input, Periodic
from uvms_core.topic import Topic
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.sensors import Sensor


def used_sensors(vehicle: Vehicle) -> Iterator[MountedSensor]:
    """Those of the vehicle's sensors whose samples navigation takes."""
    return (sensor for sensor in mounted_sensors(vehicle) if sensor.navigation)


def navigation_inputs(vehicle: Vehicle, period: int) -> dict[Topic, Input]:
    """The topics of those sensors, each at its own rate, and the thrusts of the tick before.

    Args:
        period: of the control loop, ns.
    """
    sensors: dict[Topic, Input] = {
        sensor.topic: Periodic(sample_period(sensor.section)) for sensor in used_sensors(vehicle)
    }
    return sensors | {topics.ALLOCATION: CompanionBefore(period)}


def sample_period(sensor: Sensor) -> int:
    """Nanoseconds between two samples of a sensor."""
    return to_nanoseconds(1.0 / sensor.rate_hz)
