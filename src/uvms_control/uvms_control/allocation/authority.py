"""What a thruster layout can do: its authority on each axis, its missing axes."""

import numpy as np

from uvms_control.allocation.least_squares import box_of
from uvms_core.signals import Array
from uvms_core.vehicle.reach import one_way_texts

AXES = ("X", "Y", "Z", "K", "M", "N")
# Relative size below which a part of an axis counts as outside the span of the thrusters.
SPAN_TOLERANCE = 1e-9


def axis_authority(matrix: Array, limits: Array) -> Array:
    """Largest force or moment along each axis (6,), N and N m, with all other axes at zero.

    `limits` (m,) N in either direction, or (2, m) N astern and ahead.
    """
    return np.array([_pure_authority(matrix, limits, axis) for axis in range(6)])


def _pure_authority(matrix: Array, limits: Array, axis: int) -> float:
    from scipy.optimize import linprog  # half a second, only where the authority is asked for

    others = np.delete(matrix, axis, axis=0)
    bounds = list(zip(*box_of(limits), strict=True))
    found = linprog(-matrix[axis], A_eq=others, b_eq=np.zeros(5), bounds=bounds, method="highs")
    return max(float(matrix[axis] @ found.x), 0.0) if found.success else 0.0


def axes_pushed_one_way(matrix: Array, lower: Array, upper: Array) -> tuple[str, ...]:
    """Axes with authority in one direction alone, `Z (only +)`, or in neither without one.

    `lower` and `upper` (m,) N are the limits of the thrusters. Those of `axes_without_authority`,
    which no thrust that reversed would give either, are not among them.
    """
    size = max(float(np.abs(matrix[3:]).max(initial=0.0)), SPAN_TOLERANCE)
    alike = matrix / np.array([1.0] * 3 + [size] * 3)[:, None]
    return tuple(one_way_texts(alike, lower, upper, AXES))


def axes_without_authority(matrix: Array) -> tuple[str, ...]:
    """Names of the axes along which the thrusters cannot push without pushing along another."""
    basis, sizes, _ = np.linalg.svd(matrix, full_matrices=False)
    span = basis[:, sizes > SPAN_TOLERANCE * max(sizes[0], 1e-300)]
    outside = np.linalg.norm(np.eye(6) - span @ span.T, axis=0)
    return tuple(axis for axis, part in zip(AXES, outside, strict=True) if part > 1e-6)
