"""Read, override, check, expand and write vehicle files."""

from collections.abc import Hashable, Mapping
from pathlib import Path
from typing import Any

import yaml

from uvms_dynamics.config import validated
from uvms_dynamics.errors import VehicleFileError
from uvms_dynamics.vehicle.expand import MissingShapeError, expand
from uvms_dynamics.vehicle.locate import reference_file
from uvms_dynamics.vehicle.overrides import override
from uvms_dynamics.vehicle.vehicle import Vehicle


class _UniqueKeyLoader(yaml.SafeLoader):
    """YAML as usual, but a key given twice is an error instead of the last one winning."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Hashable, Any]:
        seen = set()
        for key_node, _ in node.value:
            key = self.construct_object(key_node, deep=True)
            if key in seen:
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {key!r} is given twice", key_node.start_mark
                )
            seen.add(key)
        return super().construct_mapping(node, deep)


def load_vehicle(
    path: str | Path | None = None, overrides: Mapping[str, Any] | None = None
) -> Vehicle:
    """Vehicle of a YAML file (None: the reference vehicle) with dotted overrides.

    Overrides are put in before the words `neutral`, `trim`, `spheroid` and `cylinder` are worked
    out, so that derived values follow them. Raises VehicleFileError with one line per fault.
    """
    path = reference_file() if path is None else Path(path)
    return vehicle_from_data(_read(path), str(path), overrides or {})


def vehicle_from_data(
    data: Any, what: str = "vehicle", overrides: Mapping[str, Any] | None = None
) -> Vehicle:
    """Vehicle of plain data in the form of the YAML file; `what` names it in errors."""
    parsed = validated(Vehicle, data, what, VehicleFileError)
    if overrides:
        changed = override(parsed.model_dump(warnings=False), overrides)
        parsed = validated(Vehicle, changed, what, VehicleFileError)
    try:
        return validated(Vehicle, expand(parsed), what, VehicleFileError)
    except MissingShapeError as fault:
        raise VehicleFileError(f"{what}: {fault}") from fault


def dump_vehicle(vehicle: Vehicle) -> str:
    """The effective vehicle as YAML, every word worked out; loading it gives an equal vehicle."""
    return yaml.safe_dump(
        vehicle.model_dump(mode="json"), sort_keys=False, default_flow_style=None, width=100
    )


def vehicle_from_yaml(text: str, what: str = "vehicle") -> Vehicle:
    """Vehicle of a YAML text, such as `dump_vehicle` wrote into a log."""
    return vehicle_from_data(_parse(text, what), what)


def _read(path: Path) -> Any:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as fault:
        raise VehicleFileError(f"{path}: cannot be read: {fault}") from fault
    return _parse(text, str(path))


def _parse(text: str, what: str) -> Any:
    try:
        return yaml.load(text, Loader=_UniqueKeyLoader)
    except yaml.YAMLError as fault:
        raise VehicleFileError(f"{what}: is not valid YAML: {fault}") from fault
