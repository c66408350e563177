"""A small quadratic program by a primal active-set method, for kernels."""

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_planner.linear import solve_in_place

ROUNDING = 1e-9  # of a multiplier's own scale: a wrong sign below it is rounding


@kernel
def solve_program(hessian, gradient, lower, upper, equal, rows, limits, x, weights):
    """Minimize x^T H x / 2 + g^T x; lower <= x <= upper, `equal` x = 0, `rows` x <= `limits`.

    `x` (v,) must be feasible at the call and becomes the minimizer; `weights` (c,) become the
    multipliers of `rows` (c, v). H (v, v) is positive semidefinite. Returns the programs that were
    solved, negative where they ran out.

    Nocedal and Wright, Numerical Optimization, 2nd ed., algorithm 16.3: the minimizer on the active
    constraints; the first constraint in the way joins them, and at the minimizer the one whose
    multiplier has the wrong sign the most leaves them.
    """
    count, others = x.shape[0], rows.shape[0]
    size = count + equal.shape[0] + others
    held, active = np.zeros(count), np.zeros(others, dtype=np.bool_)  # held: -1 lower, 1 upper
    matrix, vector = np.zeros((size, size)), np.zeros(size)
    for i in range(count):
        if upper[i] <= lower[i]:
            held[i] = 2.0  # for good
    most = 5 * (count + others) + 5
    for solved in range(1, most + 1):
        _fill(hessian, gradient, equal, rows, limits, x, held, active, matrix, vector)
        if not solve_in_place(matrix, vector, size):
            return -solved
        share, blocking, side = _room(x, vector, lower, upper, rows, limits, held, active)
        for i in range(count):
            if held[i] == 0.0:
                x[i] += share * (vector[i] - x[i])
        if blocking >= count:
            active[blocking - count] = True
            continue
        if blocking >= 0:
            held[blocking] = side
            x[blocking] = upper[blocking] if side > 0.0 else lower[blocking]
            continue
        leaving = _leaving(hessian, gradient, equal, rows, x, vector, held, active, weights)
        if leaving < 0:
            return solved
        if leaving >= count:
            active[leaving - count] = False
        else:
            held[leaving] = 0.0
    return -most


@inner
def _fill(hessian, gradient, equal, rows, limits, x, held, active, matrix, vector):
    """Lagrange's equations on the active constraints; what is held keeps its value."""
    count, equations = x.shape[0], equal.shape[0]
    size = matrix.shape[0]
    for i in range(size):
        vector[i] = 0.0
        for j in range(size):
            matrix[i, j] = 0.0
    for i in range(count):
        if held[i] != 0.0:
            matrix[i, i], vector[i] = 1.0, x[i]
            continue
        vector[i] = -gradient[i]
        for j in range(count):
            matrix[i, j] = hessian[i, j]
        for a in range(equations):
            matrix[i, count + a] = equal[a, i]
        for a in range(rows.shape[0]):
            if active[a]:
                matrix[i, count + equations + a] = rows[a, i]
    for a in range(equations):
        matrix[count + a, count + a] = -1e-12
        for i in range(count):
            matrix[count + a, i] = equal[a, i]
    for a in range(rows.shape[0]):
        row = count + equations + a
        if not active[a]:
            matrix[row, row] = 1.0
            continue
        vector[row] = limits[a]
        for i in range(count):
            matrix[row, i] = rows[a, i]


@inner
def _room(x, target, lower, upper, rows, limits, held, active):
    """(share of the way to `target` that is free, what blocks it or -1, side of a bound).

    What blocks is a variable's number, or the number of variables plus that of a row.
    """
    count = x.shape[0]
    share, blocking, side = 1.0, -1, 0.0
    for i in range(count):
        way = target[i] - x[i]
        if held[i] != 0.0 or way == 0.0:
            continue
        room = (upper[i] - x[i]) / way if way > 0.0 else (lower[i] - x[i]) / way
        if room < share:
            share, blocking, side = max(room, 0.0), i, np.sign(way)
    for a in range(rows.shape[0]):
        if active[a]:
            continue
        value, way = 0.0, 0.0
        for i in range(count):
            value += rows[a, i] * x[i]
            if held[i] == 0.0:
                way += rows[a, i] * (target[i] - x[i])
        if way > 0.0 and (limits[a] - value) / way < share:
            share, blocking = max((limits[a] - value) / way, 0.0), count + a
    return share, blocking, side


@inner
def _leaving(hessian, gradient, equal, rows, x, solution, held, active, weights):
    """The active constraint whose multiplier has the wrong sign the most; -1 at the minimizer."""
    count, equations = x.shape[0], equal.shape[0]
    leaving, worst = -1, 0.0
    for a in range(rows.shape[0]):
        weights[a] = solution[count + equations + a] if active[a] else 0.0
        if weights[a] < worst:
            worst, leaving = weights[a], count + a
    for i in range(count):
        if abs(held[i]) != 1.0:
            continue
        slope, scale = gradient[i], abs(gradient[i])
        for j in range(count):
            slope += hessian[i, j] * x[j]
            scale += abs(hessian[i, j] * x[j])
        for a in range(equations):
            slope += equal[a, i] * solution[count + a]
            scale += abs(equal[a, i] * solution[count + a])
        for a in range(rows.shape[0]):
            slope += rows[a, i] * weights[a]
            scale += abs(rows[a, i] * weights[a])
        wrong = held[i] * slope  # at the upper bound the slope must be negative
        if wrong > ROUNDING * scale and -wrong < worst:
            worst, leaving = -wrong, i
    return leaving
