"""The plant's own vehicle: the nominal one with the run's overrides and mismatch.

Everything else works with the nominal vehicle. Keywords such as `neutral` and `trim` have been
replaced by values before, so that a shifted centre of buoyancy is not trimmed away.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from uvms_core.errors import ConfigError, VehicleFileError
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle, vehicle_from_data
from uvms_dynamics.simulation.plant.config import PlantConfig
from uvms_dynamics.simulation.plant.mismatch import Draws, mismatched
from uvms_dynamics.simulation.plant.overridden import check_effective, overridden


@dataclass(frozen=True)
class AsBuilt:
    """The plant's vehicle, and what makes it differ from the nominal one.

    Attributes:
        vehicle: as the plant has it; the nominal one itself where nothing differs.
        overrides: by dotted path, as they were given.
        mismatch: what was drawn, by field of `Mismatch`: relative, or in the unit of its name.
    """

    vehicle: Vehicle
    overrides: Mapping[str, Any] = field(default_factory=dict)
    mismatch: Draws = field(default_factory=dict)

    @property
    def differs(self) -> bool:
        """Whether it is not the nominal vehicle."""
        return bool(self.overrides or self.mismatch)

    @property
    def thrust_factors(self) -> Array:
        """Thrust (m,) of each thruster per newton that it is commanded."""
        draws = self.mismatch.get("thrust", np.zeros(self.vehicle.n_thrusters))
        return 1.0 + np.atleast_1d(np.array(draws, dtype=float))

    def to_data(self) -> dict[str, Any]:
        """Overrides and draws as plain data, for logs."""
        return {"vehicle_overrides": dict(self.overrides), "mismatch": dict(self.mismatch)}


def as_built(nominal: Vehicle, config: PlantConfig, seed: int) -> AsBuilt:
    """The plant's vehicle: first the overrides, then the draws about them.

    Raises:
        ConfigError: an override does not exist, is not allowed or changes what the nodes of the
            loop count on, or the result is no possible vehicle; names the field.
    """
    overrides, draws, vehicle = config.vehicle_overrides, {}, nominal
    try:
        if overrides:
            vehicle = overridden(nominal, overrides)
            _check_same_interface(nominal, vehicle)
            check_effective(nominal, overrides)
        if draws := config.mismatch.draw(vehicle, seed):
            vehicle = vehicle_from_data(mismatched(vehicle, draws), "the plant that was drawn")
    except VehicleFileError as fault:
        name = "vehicle_overrides" if vehicle is nominal and overrides else "mismatch"
        raise ConfigError(f"{name}: {fault}") from fault
    return AsBuilt(vehicle, overrides, draws)


def _check_same_interface(nominal: Vehicle, plant: Vehicle) -> None:
    """ConfigError where commands and samples of the one do not fit the other."""
    for what, of in (
        ("names of the thrusters", lambda vehicle: vehicle.thruster_names),
        ("names of the joints", lambda vehicle: vehicle.joint_names),
        ("sensors and their rates", _rates),
    ):
        if of(plant) != of(nominal):
            raise ConfigError(
                f"vehicle_overrides: the {what} are {of(plant)}, and the nodes count on"
                f" {of(nominal)}; change them by vehicle_overrides at the top of the scenario"
            )


def _rates(vehicle: Vehicle) -> dict[str, float]:
    return {name: sensor.rate_hz for name, sensor in vehicle.sensors.mounted.items()}
