"""Geometric copies of a vehicle: all lengths times a factor, all densities and speeds alike."""

import math
from typing import Any

import numpy as np

from uvms_core.vehicle import Vehicle, vehicle_from_data

POWERS = {"_m": 1, "_m2": 2, "_m3": 3, "_kg": 3, "_kg_m2": 5, "_n": 3, "_nm": 4, "_n_s": 3}
"""Power of the length in a field, by the unit in its name; forces go with weights."""


def scaled(vehicle: Vehicle, factor: float) -> Vehicle:
    """The vehicle `factor` times as long; its thrust and torque keep its speed and posture."""
    data = vehicle.model_dump(mode="json")
    for part in ("hull", "thrusters", "arm", "sensors"):
        _scale(data[part], factor)
    matrix = np.diag([factor**1.5] * 3 + [factor**2.5] * 3)
    for body in (data["hull"], *data["arm"]["links"]):
        body["added_mass"] = (matrix @ np.array(body["added_mass"]) @ matrix).tolist()
    hull = data["hull"]
    hull["linear_damping"] = _damping(hull["linear_damping"], factor, 2, 4)
    hull["quadratic_damping"] = _damping(hull["quadratic_damping"], factor, 2, 5)
    return vehicle_from_data(data, f"{vehicle.name} times {factor:g}")


def by_mass(vehicle: Vehicle, factor: float) -> Vehicle:
    """The copy that is `factor` times as heavy."""
    return scaled(vehicle, math.cbrt(factor))


def _damping(values: list[float], factor: float, linear: int, angular: int) -> list[float]:
    return [x * factor ** (linear if k < 3 else angular) for k, x in enumerate(values)]


def _scale(node: Any, factor: float) -> None:
    items = node.items() if isinstance(node, dict) else enumerate(node)
    for name, value in list(items):
        power = _power(name)
        if power and value is not None:
            node[name] = (np.array(value) * factor**power).tolist()
        elif isinstance(value, dict | list):
            _scale(value, factor)


def _power(name: Any) -> int:
    if not isinstance(name, str) or "noise" in name or "bias" in name:
        return 0
    fits = [unit for unit in POWERS if name.endswith(unit)]
    return POWERS[max(fits, key=len)] if fits else 0
