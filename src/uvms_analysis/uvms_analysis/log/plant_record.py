"""The record of how the plant differs from the nominal vehicle, and the plant's own vehicle."""

import json
from collections.abc import Mapping
from typing import Any

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import PLANT_VEHICLE, RunLog

NAME = "plant"
VEHICLE_FILE = PLANT_VEHICLE
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
