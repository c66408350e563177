"""Checks of incoming signals, done once at the boundary; messages name the value."""

import numpy as np

from uvms_core.errors import SignalError
from uvms_core.signals import Array


def checked(name: str, value: Array, shape: tuple[int, ...]) -> Array:
    """`value` as float64 of this shape with finite entries, or a SignalError that names it."""
    array = np.asarray(value, dtype=np.float64)
    if array.shape != shape:
        raise SignalError(f"{name}: shape {array.shape}, expected {shape}")
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        index = ", ".join(str(i) for i in where)
        raise SignalError(f"{name}[{index}]: {array[where]}, expected a finite number")
    return array


def checked_quaternion(name: str, value: Array, tolerance: float = 1e-3) -> Array:
    """`value` as a unit quaternion (4,), or a SignalError that names its length."""
    quaternion = checked(name, value, (4,))
    norm = float(np.linalg.norm(quaternion))
    if abs(norm - 1.0) > tolerance:
        raise SignalError(f"{name}: length {norm:.6g}, expected 1 within {tolerance:g}")
    return quaternion / norm
