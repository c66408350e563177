"""What a sensor measures: the quantities of its samples that a fault can change."""

from collections.abc import Mapping
from functools import cache
from typing import Any, get_type_hints

from uvms_core.errors import ConfigError
from uvms_core.sensors import mounted_sensors
from uvms_core.signals import JointStates, OnlyIf, Shape
from uvms_core.topics import ENCODERS
from uvms_core.vehicle import Vehicle

ROTATION = 3
"""Numbers of an error of an attitude: a rotation vector about the body axes, rad."""
_UNCERTAINTY = ("covariance", "variance")


def sensor_names(vehicle: Vehicle) -> tuple[str, ...]:
    """Names that a fault can have for `sensor`."""
    return (*vehicle.sensors.mounted, ENCODERS)


def quantities(vehicle: Vehicle, sensor: str) -> dict[str, int]:
    """Names of the measured quantities of a sensor, and how many numbers an error of each has.

    An attitude has three: its error is a rotation vector.
    """
    rules = rules_of(signal_of(vehicle, sensor))
    return {name: _size(rule, vehicle) for name, rule in rules.items()}


def signal_of(vehicle: Vehicle, sensor: str) -> type:
    """Class of a sensor's samples."""
    kinds = {each.name: each.type.signal for each in mounted_sensors(vehicle)}
    return JointStates if sensor == ENCODERS else kinds[sensor]


def is_attitude(kind: type, name: str) -> bool:
    """Whether a quantity of a signal is a unit quaternion."""
    rule = rules_of(kind)[name]
    return isinstance(rule, Shape) and rule.unit


@cache
def rules_of(kind: type) -> Mapping[str, Any]:
    """Measured fields of a signal with their rule: a shape, or None for a number."""
    found = {}
    for name, hint in get_type_hints(kind, include_extras=True).items():
        if any(word in name for word in _UNCERTAINTY):
            continue
        rules = [r for r in getattr(hint, "__metadata__", ()) if isinstance(r, Shape | OnlyIf)]
        if rules or hint is float:
            found[name] = rules[0] if rules and isinstance(rules[0], Shape) else None
    return found


def _size(rule: Shape | None, vehicle: Vehicle) -> int:
    if rule is None:
        return 1
    if rule.unit:
        return ROTATION
    (size,) = rule.sizes if len(rule.sizes) == 1 else (0,)
    return vehicle.n_joints if size == "n" else int(size)


def check_quantity(vehicle: Vehicle, sensor: str, name: str) -> None:
    """ConfigError unless the sensor measures a quantity of this name."""
    known = quantities(vehicle, sensor)
    if name not in known:
        raise ConfigError(f"field {name!r}: the {sensor} measures {', '.join(known)}")
