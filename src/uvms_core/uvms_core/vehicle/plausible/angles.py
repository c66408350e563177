"""Angles in degrees: none beyond two turns, none that looks like radians."""

import math
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from uvms_core.vehicle.plausible.finding import Finding
from uvms_core.vehicle.vehicle import Vehicle

TWO_TURNS = 720.0
"""No direction needs more, in degrees. Joint limits may: a joint may turn for ever."""

_LIMITS = ("lower_deg", "upper_deg", "stowed_deg", "postures_deg")

RADIAN_RANGE = 2.0 * math.pi * 1.01
"""A joint whose whole range is less, in degrees, moves less than seven; in radians it is a turn."""

_FRACTIONS = {
    math.pi / 4.0: "pi/4",
    math.pi / 2.0: "pi/2",
    3.0 * math.pi / 4.0: "3 pi/4",
    math.pi: "pi",
    3.0 * math.pi / 2.0: "3 pi/2",
    2.0 * math.pi: "2 pi",
}
"""Angles that files in radians are full of."""

_AS_PRINTED = 1e-3
"""1.571 for pi/2, relative."""


def check_angles(vehicle: Vehicle) -> Iterator[Finding]:
    """Every field that is an angle in degrees."""
    for path, name, value in _angles(vehicle, ""):
        yield from _turns(path, name, value)
        if name in ("alpha_deg", "offset_deg", "rpy_deg", "lower_deg", "upper_deg"):
            yield from _radians(path, value)
    yield from _ranges(vehicle)


def _turns(path: str, name: str, value: float) -> Iterator[Finding]:
    if abs(value) <= TWO_TURNS:
        return
    endless = name in _LIMITS
    why = "a joint that turns for ever?" if endless else "is it in another unit?"
    yield Finding(
        path, f"{value:g} degrees are more than two turns, {TWO_TURNS:g}; {why}", not endless
    )


def _radians(path: str, value: float) -> Iterator[Finding]:
    for angle, name in _FRACTIONS.items():
        if math.isclose(abs(value), angle, rel_tol=_AS_PRINTED):
            degrees = math.degrees(value)
            yield Finding(
                path,
                f"{value:g} degrees is the number {name}; in radians it would be {degrees:.4g}"
                " degrees, and this field is in degrees",
            )


def _ranges(vehicle: Vehicle) -> Iterator[Finding]:
    for number, joint in enumerate(vehicle.arm.joints):
        if (reach := joint.upper_deg - joint.lower_deg) < RADIAN_RANGE:
            yield Finding(
                f"arm.joints.{number}.upper_deg",
                f"joint {joint.name} can turn {reach:.3g} degrees in all, less than"
                f" {RADIAN_RANGE:.3g}; are its limits in radians?",
            )


def _angles(node: Any, path: str) -> Iterator[tuple[str, str, float]]:
    """Path, name of the field and value of every mounting, joint or posture angle."""
    if isinstance(node, BaseModel):
        for name, value in node:
            inner = f"{path}.{name}" if path else name
            if name == "sensors" or name.startswith("datum"):
                continue
            if name.endswith("_deg"):
                yield from ((place, name, x) for place, x in _numbers(value, inner))
            else:
                yield from _angles(value, inner)
    elif isinstance(node, tuple):
        for number, item in enumerate(node):
            yield from _angles(item, f"{path}.{number}")


def _numbers(value: Any, path: str) -> Iterator[tuple[str, float]]:
    if isinstance(value, dict):
        for name, item in value.items():
            yield from _numbers(item, f"{path}.{name}")
    elif isinstance(value, tuple):
        for number, item in enumerate(value):
            yield from _numbers(item, f"{path}.{number}")
    elif isinstance(value, float):
        yield path, value
