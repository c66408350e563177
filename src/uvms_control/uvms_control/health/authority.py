"""What thrusters can still do along each axis, when some of them give less than they are told.

The greatest wrench along one axis with none along the others is a linear program in the thrusts:
its optimum is a vertex, where all thrusts but as many as there are independent conditions sit at a
limit. For the handful of thrusters that a vehicle has, all vertices are worked out at once.
"""

from functools import cache, lru_cache
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array

MOST_VERTICES = 20_000
"""Beyond them, by far more than 8 thrusters have, a solver for linear programs is quicker."""
TOLERANCE = 1e-9
"""Share of the greatest thrust by which a vertex may lie beyond its limits, from rounding."""
LOST_SHARE = 0.05
"""An axis that keeps less than this share of its authority is lost: it cannot hold anything that it
was built for."""


def remaining_authority(matrix: Array, limits: Array, effectiveness: Array) -> Array:
    """Greatest force or moment along each axis (6,), both ways, with none along the others.

    Args:
        matrix: wrench of one newton of each thruster (6, m).
        limits: greatest thrusts astern (<= 0) and ahead (2, m), N.
        effectiveness: share of the command that each thruster gives (m,).
    """
    arrays = (np.ascontiguousarray(each, dtype=np.float64) for each in (matrix, limits))
    shares = np.ascontiguousarray(effectiveness, dtype=np.float64)
    given = [each.tobytes() for each in (*arrays, shares)]
    return np.array(_authority(matrix.shape[1], *given))


def lost_axes(remaining: Array, nominal: Array) -> NDArray[np.bool_]:
    """Axes (6,) along which the thrusters could push, and now cannot.

    Args:
        remaining: authority (6,) now, as `remaining_authority`.
        nominal: the same with all thrusters whole.
    """
    return (nominal > 0.0) & (remaining < LOST_SHARE * nominal)


@lru_cache(maxsize=256)
def _authority(m: int, matrix: bytes, limits: bytes, effectiveness: bytes) -> tuple[float, ...]:
    columns = np.frombuffer(matrix).reshape(6, m)
    low, high = np.frombuffer(limits).reshape(2, m) * np.frombuffer(effectiveness)
    return tuple(_along(columns, low, high, axis) for axis in range(6))


def _along(matrix: Array, low: Array, high: Array, axis: int) -> float:
    """Greatest wrench that can be had both ways along an axis alone."""
    scale = np.abs(matrix).max(axis=1)
    alive = high > low
    if scale[axis] == 0.0 or not alive.any():
        return 0.0
    rows = (matrix / np.where(scale > 0.0, scale, 1.0)[:, None])[:, alive]
    others = _independent(np.delete(rows, axis, axis=0))
    ends = _extremes(rows[axis], others, low[alive], high[alive])
    least = min(max(ends[1], 0.0), max(-ends[0], 0.0)) * scale[axis]
    return float(least) if least > TOLERANCE * scale[axis] * np.abs(high).max() else 0.0


def _independent(rows: Array) -> Array:
    """Conditions that say the same as `rows` times thrust = 0, as few as there can be."""
    _, size, right = np.linalg.svd(rows, full_matrices=False)
    return right[size > TOLERANCE * max(size.max(initial=0.0), 1.0)]


def _extremes(goal: Array, conditions: Array, low: Array, high: Array) -> tuple[float, float]:
    """Least and greatest goal @ thrust where conditions @ thrust = 0 within the limits."""
    r, m = conditions.shape
    if r == m:
        return 0.0, 0.0
    free, fixed, at_high = _vertices(m, r)
    if free.shape[0] == 0:
        return _by_solver(goal, conditions, low, high)
    thrust = np.empty((free.shape[0], m))
    rows = np.arange(free.shape[0])[:, None]
    thrust[rows, fixed] = np.where(at_high, high[fixed], low[fixed])
    if r:
        own = conditions[:, free].transpose(1, 0, 2)
        usable = np.abs(np.linalg.det(own)) > TOLERANCE
        free, fixed, thrust, own = free[usable], fixed[usable], thrust[usable], own[usable]
        rows = np.arange(free.shape[0])[:, None]
        rest = np.einsum("rkf,kf->kr", conditions[:, fixed], thrust[rows, fixed])
        thrust[rows, free] = np.linalg.solve(own, -rest[:, :, None])[:, :, 0]
    margin = TOLERANCE * np.maximum(np.abs(low), np.abs(high)).max()
    inside = ((thrust >= low - margin) & (thrust <= high + margin)).all(axis=1)
    values = thrust[inside] @ goal
    return (float(values.min(initial=0.0)), float(values.max(initial=0.0)))


@cache
def _vertices(m: int, r: int) -> tuple[NDArray, NDArray, NDArray]:
    """Which thrusts follow from the conditions, which sit at a limit, and at the upper one."""
    bases = list(combinations(range(m), r))
    sides = list(product((False, True), repeat=m - r))
    if len(bases) * len(sides) > MOST_VERTICES:
        return np.empty((0, r), int), np.empty((0, m - r), int), np.empty((0, m - r), bool)
    pairs = [(base, side) for base in bases for side in sides]
    free = np.array([base for base, _ in pairs], dtype=int).reshape(len(pairs), r)
    fixed = np.array([[i for i in range(m) if i not in base] for base, _ in pairs], dtype=int)
    return free, fixed, np.array([side for _, side in pairs], dtype=bool)


def _by_solver(goal: Array, conditions: Array, low: Array, high: Array) -> tuple[float, float]:
    from scipy.optimize import linprog  # half a second, only where there are very many thrusters

    bounds = np.column_stack([low, high])
    ends = [
        linprog(sign * goal, A_eq=conditions, b_eq=np.zeros(len(conditions)), bounds=bounds)
        for sign in (1.0, -1.0)
    ]
    return (float(ends[0].fun or 0.0), -float(ends[1].fun or 0.0))
