"""Geometric copies of a vehicle: other lengths, the same densities, speeds and joint rates.

With the factor L on all lengths masses grow with L^3, inertia with L^5 and forces with the weights,
L^3. Resistance keeps its form, so that at the same speed it grows with the areas, L^2: a larger
copy has more thrust for its size, and is faster, as larger ships are.
"""

import re
from typing import Any

import numpy as np

POWERS: dict[str, float] = {
    "_m": 1,
    "_m2": 2,
    "_m3": 3,
    "_kg": 3,
    "_kg_m2": 5,
    "_n": 3,
    "_n_s": 3,
    "_nm": 4,
    "_nm_s": 4,
    "_nm_rad": 4,
    "_s_rad": 1,
    "_w": 3.5,
    "_ah": 3,
    "_wh": 3,
    "_ohm": -3,
}
"""Power of the length in a field, by the unit that its name ends with.

That of the end stops' dissipation is chosen so that the rate at which a stop takes energy from a
joint, effort x dissipation / inertia, stays: a small copy then needs no shorter integration step.
That of a thruster's power is the actuator disc's, T^1.5 over the root of an area. A battery holds
as much for its mass, and is so many cells more or less side by side, with the same voltage. The
hotel load goes with the thrusters' power.
"""
SECTIONS = ("hull", "thrusters", "arm")
"""What is scaled, and the electrical side; of the sensors only the places are, and water and tether
are the same."""
PRODUCT = re.compile(r"[XYZKMN]_u[vwpqr]")
"""Products of velocities in a force or moment, such as Y_uv."""
MOMENTS, TURNS = "KMN", "pqr"


def scaled_data(data: dict[str, Any], factor: float) -> dict[str, Any]:
    """Plain data of a complete vehicle (without keywords) whose lengths are times `factor`."""
    copy = dict(data)
    for section in SECTIONS:
        copy[section] = _scaled(data[section], factor)
    copy["sensors"] = _places(data["sensors"], factor)
    copy["electrical"] = _scaled(data.get("electrical"), factor)
    hull = copy["hull"]
    for body in (hull, *copy["arm"]["links"]):
        body["added_mass"] = _matrix(body["added_mass"], factor, 3, 1)
    hull["linear_damping"] = _matrix(hull["linear_damping"], factor, 2, 1)
    hull["quadratic_damping"] = _matrix(hull["quadratic_damping"], factor, 2, 2)
    return copy


def _matrix(values: Any, factor: float, power: int, of_rate: int) -> Any:
    """Six diagonal values or 6 rows: L^power of forces by speeds, L more of moments.

    A rate of turn goes with speed over length, so that its columns have `of_rate` powers more.
    """
    row = np.array([0, 0, 0, 1, 1, 1])
    array = np.array(values, dtype=float)
    powers = power + row[:, None] + of_rate * row
    own = powers if array.ndim == 2 else np.diag(powers)
    return (array * factor**own).tolist()


def _scaled(node: Any, factor: float) -> Any:
    if isinstance(node, dict):
        return {name: _field(name, value, factor) for name, value in node.items()}
    return [_scaled(item, factor) for item in node] if isinstance(node, list) else node


def _field(name: str, value: Any, factor: float) -> Any:
    power = _power(name)
    if power is None or value is None:
        return _scaled(value, factor)
    return (np.array(value, dtype=float) * factor**power).tolist()


def _power(name: str) -> float | None:
    if PRODUCT.fullmatch(name):
        return 2 + (name[0] in MOMENTS) + (name[3] in TURNS)
    fits = [unit for unit in POWERS if name.endswith(unit)]
    return POWERS[max(fits, key=len)] if fits else None


def _places(node: Any, factor: float) -> Any:
    """The sensors: their errors are those of the same instruments."""
    if isinstance(node, dict):
        return {
            name: _field(name, value, factor) if name == "position_m" else _places(value, factor)
            for name, value in node.items()
        }
    return node
