"""Values of the vehicle file that the plant alone has, after everything is worked out."""

import re
from collections.abc import Mapping
from typing import Any

from uvms_core.errors import ConfigError
from uvms_core.vehicle import Vehicle, vehicle_from_data
from uvms_core.vehicle.damping import lift_alone
from uvms_core.vehicle.derived import LINK_FIELDS

SHAPE = re.compile(r"(hull\.spheroid|arm\.links\.([^.]+)\.cylinder)(\..+)?")
"""Paths of the shapes from which other fields follow."""
HULL_FIELDS = ("volume_m3", "inertia_kg_m2", "added_mass")
"""Fields that follow from `hull.spheroid`."""


def overridden(nominal: Vehicle, overrides: Mapping[str, Any]) -> Vehicle:
    """The vehicle without keywords, with values at dotted paths replaced.

    The lift of the hull's cross terms stays where added mass is replaced and they are not. Raises
    VehicleFileError for a path that does not exist and for a vehicle that cannot be.
    """
    if _touches(overrides, "hull.added_mass") and not _touches(overrides, "hull.cross_terms"):
        hull = nominal.hull.model_copy(update={"cross_terms": lift_alone(nominal.hull)})
        nominal = nominal.model_copy(update={"hull": hull})
    return vehicle_from_data(nominal.model_dump(warnings=False), "plant", overrides)


def _touches(overrides: Mapping[str, Any], field: str) -> bool:
    return any(path == field or path.startswith(f"{field}.") for path in overrides)


def check_effective(nominal: Vehicle, overrides: Mapping[str, Any]) -> None:
    """Refuse overrides of shapes from which nothing follows any more.

    Raises:
        ConfigError: the vehicle has the same numbers without one; names the fields to set instead.
    """
    for path in overrides:
        if (shape := SHAPE.fullmatch(path)) is None:
            continue
        others = {name: value for name, value in overrides.items() if name != path}
        if _numbers(overridden(nominal, overrides)) != _numbers(overridden(nominal, others)):
            continue
        link = shape.group(2)
        fields = HULL_FIELDS if link is None else LINK_FIELDS
        section = "hull" if link is None else f"arm.links.{link}"
        raise ConfigError(
            f"vehicle_overrides: {path} changes nothing of the plant: what follows from"
            f" {shape.group(1)} has been worked out before; override"
            f" {', '.join(f'{section}.{field}' for field in fields)} themselves, or set the shape"
            " by vehicle_overrides at the top of the scenario, for plant and nodes alike"
        )


def _numbers(vehicle: Vehicle) -> Vehicle:
    """The vehicle without the shapes, which have no effect of their own on its motion."""
    links = tuple(link.model_copy(update={"cylinder": None}) for link in vehicle.arm.links)
    arm = vehicle.arm.model_copy(update={"links": links})
    hull = vehicle.hull.model_copy(update={"spheroid": None})
    return vehicle.model_copy(update={"arm": arm, "hull": hull})
