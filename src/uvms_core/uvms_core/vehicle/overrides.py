"""Dotted overrides of a vehicle file: `arm.joints.1.effort_limit_nm=30`."""

from collections.abc import Mapping
from typing import Any

from uvms_core import registry
from uvms_core.errors import VehicleFileError

SENSORS = "sensors"
"""Section to which sensors may be added that the file does not have."""


def override(data: Any, overrides: Mapping[str, Any]) -> Any:
    """Copy of `data` with the value at each dotted path replaced.

    An item of a list is named by its number or, where the items have names, by its name. Raises
    VehicleFileError for a path that does not exist, with the choices at the place where it ends. A
    sensor that the file does not have can be added as a whole.
    """
    for path, value in overrides.items():
        data = _replaced(data, path.split("."), value, path, done="")
    return data


def _replaced(node: Any, parts: list[str], value: Any, path: str, done: str) -> Any:
    if not parts:
        return value
    keys = _keys(node)
    if done == SENSORS:
        keys |= {name: name for name in registry.names(registry.SENSORS)}
        if len(parts) == 1 and isinstance(value, Mapping) and "type" in value:
            keys.setdefault(parts[0], parts[0])  # of a kind that it names, under any name
    key = keys.get(parts[0])
    if key is None:
        where = done or "the vehicle file"
        choices = f"choose from {', '.join(keys)}" if keys else "it has no fields"
        if node is None:
            choices = f"the file does not have this section; set {done} as a whole"
        raise VehicleFileError(f"override {path}: {where} has no {parts[0]!r}; {choices}")
    inner = f"{done}.{parts[0]}" if done else parts[0]
    copy = dict(node) if isinstance(node, Mapping) else list(node)
    within = node[key] if isinstance(node, list | tuple) or key in node else None
    copy[key] = _replaced(within, parts[1:], value, path, inner)
    return copy


def _keys(node: Any) -> dict[str, Any]:
    """What may follow in a path, as text, with the key that it stands for."""
    if isinstance(node, Mapping):
        return {str(key): key for key in node}
    if not isinstance(node, list | tuple):
        return {}
    keys: dict[str, Any] = {str(i): i for i in range(len(node))}
    for i, item in enumerate(node):
        if isinstance(item, Mapping) and "name" in item:
            keys.setdefault(str(item["name"]), i)
    return keys
