"""Samples of all sensors in the order of their stamps."""

from collections.abc import Iterable, Mapping, Sequence
from operator import itemgetter
from typing import Any, NamedTuple

from uvms_core import registry
from uvms_core.checks import ROUNDED, is_unit
from uvms_core.errors import SignalError
from uvms_core.sensors import BUILT_IN, mounted_sensors
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_observer.navigation.measurements.base import Measurement
from uvms_observer.navigation.navigation_config import NavigationConfig

_ORDER = itemgetter(0, 1)


class Reading(NamedTuple):
    """One sample and the sensor that it comes from."""

    stamp: int  # ns
    rank: int  # place of the sensor among those of the vehicle
    name: str  # of the sensor
    sample: Any


class Instruments:
    """The sensors of a vehicle that the filter uses, in the order of its file: the IMU first.

    Raises:
        PluginError: no installed package brings the measurement of a sensor.
    """

    def __init__(self, vehicle: Vehicle, config: NavigationConfig) -> None:
        sensors = mounted_sensors(vehicle)
        self.unused = frozenset(each.name for each in sensors if not each.navigation)
        mounted = {each.type.name for each in sensors}
        self.absent = tuple(kind.name for kind in BUILT_IN if kind.name not in mounted)
        """Kinds of sensors that most vehicles have, and this one has not."""
        used = [each for each in sensors if each.navigation]
        self.measurements: dict[str, Measurement] = {}
        for each in used:
            make = registry.load(registry.MEASUREMENTS, each.type.name)
            self.measurements[each.name] = make(vehicle, each.section, config)
        self.periods = {each.name: 1.0 / each.section.rate_hz for each in used}
        """Time between two samples of each sensor, s."""
        self._ranks = {name: rank for rank, name in enumerate(self.measurements)}

    def readings(self, groups: Mapping[str, Sequence[Any]]) -> list[Reading]:
        """Samples by sensor as readings, in order.

        Raises:
            SignalError: the vehicle has no sensor of that name.
        """
        for name in groups:
            if name not in self._ranks and name not in self.unused and groups[name]:
                choices = ", ".join(self._ranks)
                raise SignalError(f"samples of {name!r}: the vehicle has {choices}")
        return in_order([
            Reading(sample.stamp, rank, name, sample)
            for name, rank in self._ranks.items()
            for sample in groups.get(name, ())
        ])  # fmt: skip


def in_order(readings: Iterable[Reading]) -> list[Reading]:
    """Readings by stamp; of the same stamp the IMU first, which carries the state there."""
    return sorted(readings, key=_ORDER)


def is_nearly_unit(quaternion: Array) -> bool:
    """Whether a quaternion (4,) is off unit length, but by less than `ROUNDED`."""
    squared = float(quaternion.dot(quaternion))
    return not is_unit(squared) and abs(squared**0.5 - 1.0) < ROUNDED
