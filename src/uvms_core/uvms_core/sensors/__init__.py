"""Kinds of sensors: those that are built in, and those that other packages bring.

A sensor is a model (entry point in `uvms.sensors`), whose attribute `type` is its `SensorType`, and
a measurement of the navigation filter (entry point in `uvms.measurements`).
"""

from uvms_core import registry
from uvms_core.errors import PluginError
from uvms_core.sensors import dvl, gps, imu, pressure
from uvms_core.sensors.mounted import MountedSensor
from uvms_core.sensors.mounting import Axes
from uvms_core.sensors.type import SensorType
from uvms_core.vehicle.further_sensors import kind_of
from uvms_core.vehicle.vehicle import Vehicle

__all__ = [
    "BUILT_IN",
    "INERTIAL",
    "Axes",
    "MountedSensor",
    "SensorType",
    "inertial",
    "mounted_sensors",
    "sensor_type",
]

BUILT_IN: tuple[SensorType, ...] = (imu.TYPE, dvl.TYPE, pressure.TYPE, gps.TYPE)
"""The kinds that every installation knows, in the order in which navigation takes samples of one
stamp."""

INERTIAL = imu.TYPE
"""Carries the estimate from stamp to stamp; its samples start the ticks of navigation."""

_BY_NAME = {each.name: each for each in BUILT_IN}


def sensor_type(name: str) -> SensorType:
    """The kind of sensor of this name.

    Raises:
        PluginError: no package registers it, or its entry does not fit; says why.
    """
    if name in _BY_NAME:
        return _BY_NAME[name]
    found = getattr(registry.load(registry.SENSORS, name), "type", None)
    if not isinstance(found, SensorType) or found.name != name:
        raise PluginError(
            f"sensor {name!r}: its class needs an attribute `type`, a SensorType of this name;"
            f" it is {found!r}"
        )
    return found


def mounted_sensors(vehicle: Vehicle) -> tuple[MountedSensor, ...]:
    """The sensors of a vehicle, in the order of its sections; raises as `sensor_type`."""
    return tuple(
        MountedSensor(name, sensor_type(kind_of(name, section)), section)
        for name, section in vehicle.sensors.mounted.items()
    )


def inertial(vehicle: Vehicle) -> MountedSensor:
    """The inertial unit of a vehicle."""
    return MountedSensor(INERTIAL.name, INERTIAL, vehicle.sensors.imu)
