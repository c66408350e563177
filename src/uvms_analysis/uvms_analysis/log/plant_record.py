"""The record of how the plant differs from the nominal vehicle, and the plant's own vehicle."""

import json
from collections.abc import Mapping
from typing import Any

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.loader import vehicle_from_yaml

NAME = "plant"
VEHICLE_FILE = "plant_vehicle.yaml"
"""Attachment with the plant's own vehicle, where it is not the nominal one."""
FIELDS = ("vehicle_overrides", "mismatch")


def to_metadata(data: Mapping[str, Any]) -> dict[str, str]:
    """The record as names and JSON texts."""
    return {name: json.dumps(data[name]) for name in FIELDS}


def read(log: RunLog) -> dict[str, Any]:
    """Overrides by path and draws by field; both empty where nothing differs.

    Raises:
        LogError: the record is damaged.
    """
    record = log.metadata.get(NAME, {})
    try:
        return {name: json.loads(record.get(name, "{}")) for name in FIELDS}
    except ValueError as fault:
        raise LogError(f"log {log.path}: its record of the plant is damaged: {fault}") from fault


def vehicle(log: RunLog) -> Vehicle | None:
    """The plant's own vehicle; None where it is the nominal one.

    Raises:
        LogError: its attachment is damaged.
    """
    if VEHICLE_FILE not in log.attachments:
        return None
    what = f"log {log.path}: its attachment {VEHICLE_FILE!r}"
    try:
        return vehicle_from_yaml(log.text(VEHICLE_FILE), what)
    except VehicleFileError as fault:
        raise LogError(str(fault)) from fault
