"""Checks of incoming samples, done once before anything changes; messages name the value."""

from math import isfinite
from typing import Any

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.signals import Array

QUATERNION_TOLERANCE = 1e-3
"""A quaternion from outside may be off unit length by this much."""


def number(name: str, value: float) -> None:
    """SignalError unless the value is finite."""
    if not isfinite(value):
        raise SignalError(f"{name} is {value}; it must be finite")


def array(name: str, value: Any, shape: tuple[int, ...]) -> None:
    """SignalError unless the value is a float64 array of this shape with finite entries."""
    if not isinstance(value, np.ndarray) or value.dtype != np.float64:
        kind = value.dtype if isinstance(value, np.ndarray) else type(value).__name__
        raise SignalError(f"{name} has type {kind}; it must be an array of float64")
    if value.shape != shape:
        raise SignalError(f"{name} has shape {value.shape}; it must have {shape}")
    flat = value.ravel()
    if not isfinite(flat.dot(flat)):  # one fast test; the slow way only names the culprit
        _name_culprit(name, value)


def quaternion(name: str, value: Any) -> None:
    """SignalError unless the value is a unit quaternion (4,)."""
    array(name, value, (4,))
    length = float(value.dot(value)) ** 0.5
    if abs(length - 1.0) > QUATERNION_TOLERANCE:
        raise SignalError(f"{name} has length {length:g}; it must be 1")


def later(name: str, stamp: int, than: int, of: str) -> None:
    """SignalError unless the stamp comes after another."""
    if stamp <= than:
        raise SignalError(f"{name} is {stamp} ns; it must be after {of}, {than} ns")


def _name_culprit(name: str, value: Array) -> None:
    for where in np.argwhere(~np.isfinite(value)):
        index = ", ".join(str(int(i)) for i in where)
        raise SignalError(f"{name}[{index}] is {value[tuple(where)]}; it must be finite")
