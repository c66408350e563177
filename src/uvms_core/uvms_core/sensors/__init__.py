"""Kinds of sensors: those that every vehicle has, and those that other packages bring.

A sensor is a model (entry point in `uvms.sensors`), whose attribute `type` is its `SensorType`, and
a measurement of the navigation filter (entry point in `uvms.measurements`).
"""

from uvms_core import registry
from uvms_core.errors import PluginError
from uvms_core.sensors import dvl, gps, imu, pressure
from uvms_core.sensors.type import SensorType
from uvms_core.vehicle.vehicle import Vehicle

__all__ = ["BUILT_IN", "INERTIAL", "SensorType", "sensor_type", "sensor_types"]

BUILT_IN: tuple[SensorType, ...] = (imu.TYPE, dvl.TYPE, pressure.TYPE, gps.TYPE)
"""The sensors of every vehicle, in the order in which navigation takes samples of one stamp."""

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


def sensor_types(vehicle: Vehicle) -> tuple[SensorType, ...]:
    """The kinds of sensors of a vehicle, in the order of its sections; raises as `sensor_type`."""
    return tuple(sensor_type(name) for name in vehicle.sensors.mounted)
