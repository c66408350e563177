"""Read, override, check, complete and write vehicle files."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from uvms_core.config import validated
from uvms_core.errors import VehicleFileError
from uvms_core.vehicle.copies import copied, with_path_from
from uvms_core.vehicle.derived import MissingShapeError, with_derived_values
from uvms_core.vehicle.locate import REFERENCE, vehicle_path
from uvms_core.vehicle.overrides import override
from uvms_core.vehicle.plausible import implausible, vehicle_warnings
from uvms_core.vehicle.plausible.water import check_water
from uvms_core.vehicle.printed import rounding_notes
from uvms_core.vehicle.vehicle import Vehicle
from uvms_core.yaml_text import dump_yaml, parse_yaml, read_yaml

_LONGEST_VALUE = 40  # characters of an override that an error repeats


def load_vehicle(
    path: str | Path | None = None, overrides: Mapping[str, Any] | None = None
) -> Vehicle:
    """Vehicle of a YAML file, or by name (None: the reference vehicle), with dotted overrides.

    Overrides are applied before the keywords `neutral`, `trim`, `spheroid` and `cylinder` are
    evaluated, so that derived values follow them. Raises VehicleFileError with a line per fault:
    values that are not allowed, or that no vehicle can have (`uvms_core.vehicle.plausible`).
    """
    path = vehicle_path(REFERENCE if path is None else path)
    return vehicle_from_data(_read(path), str(path), overrides)


def _read(path: Path) -> Any:
    return with_path_from(read_yaml(path, str(path), VehicleFileError), path.parent)


@dataclass(frozen=True)
class Examination:
    """A vehicle, with what is odd about it and what was taken for the rounding of print."""

    vehicle: Vehicle
    warnings: tuple[str, ...]
    notes: tuple[str, ...]


def examine_vehicle(
    path: str | Path | None = None, overrides: Mapping[str, Any] | None = None
) -> Examination:
    """As `load_vehicle`, with all that there is to say about the vehicle; raises as it does."""
    path = vehicle_path(REFERENCE if path is None else path)
    data = copied(_read(path), str(path), _complete_data)
    vehicle = vehicle_from_data(data, str(path), overrides)
    parsed = validated(Vehicle, data, str(path), VehicleFileError)
    notes = list(rounding_notes(data, parsed))
    if overrides:
        changed = override(parsed.model_dump(warnings=False), overrides)
        notes += rounding_notes(changed, validated(Vehicle, changed, str(path), VehicleFileError))
    return Examination(vehicle, vehicle_warnings(vehicle), tuple(notes))


def vehicle_from_data(
    data: Any, what: str = "vehicle", overrides: Mapping[str, Any] | None = None
) -> Vehicle:
    """Vehicle of plain data in the form of the YAML file; `what` names it in errors."""
    parsed, what = _parsed(data, what, overrides)
    vehicle = _completed(parsed, what)
    if faults := implausible(vehicle):
        raise VehicleFileError("\n".join(f"{what}: {fault}" for fault in faults))
    return vehicle


def _parsed(data: Any, what: str, overrides: Mapping[str, Any] | None) -> tuple[Vehicle, str]:
    """The file's values with overrides, and what errors call the two; keywords stay."""
    data = copied(data, what, _complete_data)
    parsed = validated(Vehicle, data, what, VehicleFileError)
    if not overrides:
        return parsed, what
    changed = override(parsed.model_dump(warnings=False), overrides)
    what = _with(what, overrides)
    return validated(Vehicle, changed, what, VehicleFileError), what


def _completed(parsed: Vehicle, what: str) -> Vehicle:
    """The vehicle without keywords, whose values follow from the water as well."""
    if faults := [finding for finding in check_water(parsed) if finding.is_error]:
        raise VehicleFileError("\n".join(f"{what}: {fault}" for fault in faults))
    try:
        return validated(Vehicle, with_derived_values(parsed), what, VehicleFileError)
    except MissingShapeError as fault:
        raise VehicleFileError(f"{what}: {fault}") from fault


def _complete_data(data: Any, what: str) -> dict[str, Any]:
    return vehicle_from_data(data, what).model_dump(mode="json")


def dump_vehicle(vehicle: Vehicle) -> str:
    """The effective vehicle as YAML, without keywords; loading it gives an equal vehicle."""
    return dump_yaml(vehicle.model_dump(mode="json"), default_flow_style=None, width=100)


def vehicle_from_yaml(text: str, what: str = "vehicle") -> Vehicle:
    """Vehicle of a YAML text, such as `dump_vehicle` wrote into a log."""
    return vehicle_from_data(parse_yaml(text, what, VehicleFileError), what)


def _with(what: str, overrides: Mapping[str, Any]) -> str:
    """The file's name with the overrides: one of them causes the error that follows."""
    changes = ", ".join(f"{path}={_short(value)}" for path, value in overrides.items())
    return f"{what} with {changes}"


def _short(value: Any) -> str:
    text = str(value)
    return text if len(text) <= _LONGEST_VALUE else f"{text[: _LONGEST_VALUE - 3]}..."
