"""Lexicographic thrust allocation: axes in levels of priority, bounds exactly, then least thrusts.

Thrusts are solved for as shares of the limits, and the rows of the wrench are divided by the
authority of each axis, as in `least_squares`. What the levels ask for without bounds is linear in
the wrench: that inverse is computed once, and a wrench within reach costs one product with it.

Not every layout can push along every axis by itself: a heave thruster ahead of the origin pitches
as it heaves. An axis that depends on others is left out, or it would be paid for with them. Which
one of those that depend on each other: first roll and pitch, which the hull rights by itself, then
the axis that comes last in priority.
"""

from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np

from uvms_control.allocation.levels import solve_levels, workspace
from uvms_control.errors import AllocationError
from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel

AXES = ("X", "Y", "Z", "K", "M", "N")
RIGHTED = (3, 4)
"""Axes along which hydrostatics bring the hull back: roll and pitch."""
OWN_SHARE = 0.05
"""Share of its authority that an axis must have independently of the others, or it is left out. To
push along it alone would take thrusts 20 times those that push along it and others at once."""
MAX_STEPS_PER_VARIABLE = 60
ATTAINED = 1e-9
"""Error, as a share of the authority, that counts as none where the direction is kept."""


class LexicographicLeastSquares:
    """Solver for one thruster layout."""

    def __init__(
        self,
        matrix: Array,
        box: Array,
        weights: Array,
        priorities: Sequence[Sequence[int]],
        authority: Array,
    ) -> None:
        """`matrix` (6, m) wrench per newton, `box` (2, m) N astern and ahead.

        `weights` (6,) between the axes of a level, 0 for an axis that is left out; `priorities`
        levels of axes, 0 to 5; `authority` (6,) N and N m by which errors are compared.
        """
        self.matrix = np.ascontiguousarray(matrix, dtype=np.float64)
        self.limits = np.maximum(-box[0], box[1])
        self._scale = weights / np.where(authority > 0.0, authority, 1.0)
        scaled = self._scale[:, None] * matrix * self.limits
        levels = [[axis for axis in level if self._scale[axis] > 0.0] for level in priorities]
        order = [axis for level in levels for axis in level]
        kept = independent_axes(scaled, order)
        levels = [found for level in levels if (found := [axis for axis in level if axis in kept])]
        self.axes = np.array([axis for level in levels for axis in level], dtype=np.int64)
        self.left_out = tuple(sorted(set(order) - kept))
        self._rows = np.ascontiguousarray(scaled[self.axes])
        self._ends = np.cumsum([len(level) for level in levels], dtype=np.int64)
        m = self.limits.size
        self._work, self._whole = workspace(max(len(self.axes), 1), m)
        self.max_steps = MAX_STEPS_PER_VARIABLE * (m + 6)
        self._inverse = self._without_bounds()
        self._problem = (self._rows, self._ends, self.axes, self._scale, self.limits, self._inverse)

    def _without_bounds(self) -> Array:
        """What the levels make of each unit of the wrench's rows, without bounds (m, r)."""
        count, m = len(self.axes), self.limits.size
        free, columns = np.full(m, np.inf), np.zeros((count, m))
        for target, u in zip(np.eye(count), columns, strict=True):
            steps = solve_levels(
                self._rows, self._ends, target, -free, free, u, self._work, self._whole,
                self.max_steps,
            )  # fmt: skip
            assert steps > 0, "without bounds each level takes one step"
        return np.ascontiguousarray(columns.T)

    @property
    def tables(self) -> tuple[Array, Array, Array]:
        """Matrix (6, m), scale of the axes' errors (6,), limits (m,) N."""
        return self.matrix, self._scale, self.limits

    def problem(self, tau: Array) -> tuple[None, Any]:
        """The problem for the wrench `tau` (6,) as `solve_levels` takes it."""
        target, u = (self._scale * tau)[self.axes], np.zeros(self.limits.size)
        return None, (self._rows, self._ends, target, u, self._work, self._whole)

    def reset(self) -> None:
        """Nothing: it starts from what the wrench takes without bounds, not from the last."""

    def solve(self, tau: Array, lower: Array, upper: Array) -> Array:
        """Thrusts (m,) N for the wrench `tau` (6,) within bounds (m,) N."""
        thrust = np.empty(self.limits.size)
        steps = allocate(
            self._problem, tau, lower, upper, thrust, self._work, self._whole, self.max_steps
        )
        if steps < 0:
            self.fail(tau)
        return thrust

    def solve_along(self, tau: Array, lower: Array, upper: Array) -> Array | None:
        """Thrusts (m,) N for the largest share, up to 1, of the wrench that they can give exactly.

        The share is one more variable s: B u - s tau = 0 comes first, then s = 1, then the least
        thrusts. None where no share is within reach (bounds that do not hold 0). Axes that are
        left out do not count.
        """
        target = (self._scale * tau)[self.axes]
        size = float(np.abs(target).max(initial=0.0))
        count, m = self._rows.shape
        if size == 0.0:
            return None
        rows = np.zeros((count + 1, m + 1))
        rows[:-1, :-1], rows[:-1, -1], rows[-1, -1] = self._rows, -target / size, 1.0 / size
        u, low, high = np.zeros(m + 1), np.zeros(m + 1), np.full(m + 1, size)
        low[:-1], high[:-1] = lower / self.limits, upper / self.limits
        goal, ends = np.append(np.zeros(count), 1.0), np.array([count, count + 1])
        steps = solve_levels(rows, ends, goal, low, high, u, *workspace(count + 1, m + 1), self.max_steps)
        if steps < 0:
            self.fail(tau)
        if np.abs(rows[:-1] @ u).max(initial=0.0) > ATTAINED:
            return None
        return np.clip(u[:-1] * self.limits, lower, upper)

    def fail(self, tau: Array) -> NoReturn:
        """Raise AllocationError: no thrust was found for this wrench (6,)."""
        raise AllocationError(
            f"no thrust found for the wrench {np.array2string(tau, precision=6)}: after"
            f" {self.max_steps} steps of the active-set method the optimum was not reached"
        )


def independent_axes(rows: Array, order: Sequence[int]) -> set[int]:
    """Axes of `order`, most important first, along which thrusters push independently.

    `rows` (6, m) of any scale. Roll and pitch come after the others here.
    """
    basis: list[Array] = []
    kept = set()
    for axis in sorted(order, key=lambda each: each in RIGHTED):
        row = rows[axis]
        rest = row - sum((b * (b @ row) for b in basis), np.zeros_like(row))
        rest -= sum((b * (b @ rest) for b in basis), np.zeros_like(row))
        size = np.linalg.norm(rest)
        if size > OWN_SHARE * np.linalg.norm(row):
            basis.append(rest / size)
            kept.add(axis)
    return kept


@exact_kernel
def allocate(problem, tau, lower, upper, thrust, work, whole, max_steps):
    """Thrusts (m,) N of a wrench `tau` (6,) into `thrust`; steps taken, 0 where no bound matters.

    `problem`: rows, ends of the levels, axis of each row, scale (6,) of the axes, limits (m,) N,
    inverse (m, r). Returns TOO_MANY_STEPS (negative) on failure.
    """
    rows, ends, axes, scale, limits, inverse = problem
    r, m = rows.shape
    scratch = np.empty((4, max(r, m)))
    target, low, high, u = scratch[0, :r], scratch[1, :m], scratch[2, :m], scratch[3, :m]
    for a in range(r):
        target[a] = scale[axes[a]] * tau[axes[a]]
    within = True
    for i in range(m):
        low[i], high[i] = lower[i] / limits[i], upper[i] / limits[i]
        total = 0.0
        for a in range(r):
            total += inverse[i, a] * target[a]
        u[i] = total
        within = within and low[i] <= total <= high[i]
    steps = 0
    if not within:
        steps = solve_levels(rows, ends, target, low, high, u, work, whole, max_steps)
    for i in range(m):
        thrust[i] = min(max(u[i] * limits[i], lower[i]), upper[i])
    return steps
