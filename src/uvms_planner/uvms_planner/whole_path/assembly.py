"""Cost, gradient and banded Gauss-Newton matrix of a plan, sample by sample.

F(c) = 1/2 sum w |r|^2 + sum w P(g): the integral of the squared wrenches by Gauss's quadrature,
the penalties of the sampled limits by the same weights, and those of the limits that are linear
in the coefficients c.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_planner.whole_path.barrier import linearised, penalty
from uvms_planner.whole_path.sample import (
    MANIPULABILITY,
    NEAR_M,
    THRUST,
    TURN,
    WRENCHES,
    read_aim,
    sample_jacobian,
    sample_values,
)
from uvms_planner.whole_path.spline import DEGREE
from uvms_planner.whole_path.tool_turn import WANTED_ROWS

FUNCTIONS = DEGREE + 1


class Grid(NamedTuple):
    """Where the plan is judged."""

    first: Array  # (k,) first spline function at each sample
    basis: Array  # (k, 3, FUNCTIONS)
    weights: Array  # (k,) s, of the quadrature
    numbers: Array  # (K,) block of unknowns of each coefficient, -1 where it is given


class Bounds(NamedTuple):
    """Of the sampled values from POSITION on: lower <= v <= upper, in units of `scale`."""

    lower: Array  # (v,)
    upper: Array  # (v,)
    scale: Array  # (v,)
    floor: Array  # (v,) below which a value is as good as there
    price: Array  # (v,) of breaking it, relative to that of a limit of the posture


class Rows(NamedTuple):
    """Limits of sum_j a_j c[first + j, dimension], three coefficients at most."""

    first: Array  # (r,)
    dimension: Array  # (r,)
    factors: Array  # (r, 3)
    lower: Array  # (r,)
    upper: Array  # (r,)
    scale: Array  # (r,)
    weights: Array  # (r,) s


class Wishes(NamedTuple):
    """What costs a little: motion, nearness to stops and to singular postures, a turn away."""

    motion: Array  # (3, d) weights of posture (unused), rates and accelerations squared
    low: Array  # (d,) posture below which the stop is near
    high: Array  # (d,)
    stop: Array  # (d,) weight of the distance beyond, squared
    turn: float  # weight of the turn, squared
    singular: float  # weight of the lack of manipulability, squared, which is 1 at a singularity
    enough: float  # manipulability that lacks nothing


@inner
def _posture(grid, coefficients, i, motion):
    """Fill `motion` (3, d) with the spline's value and derivatives at sample i."""
    for row in range(3):
        for column in range(motion.shape[1]):
            total = 0.0
            for a in range(FUNCTIONS):
                total += grid.basis[i, row, a] * coefficients[grid.first[i] + a, column]
            motion[row, column] = total


@inner
def _beyond(wishes, k, x):
    """How far a posture is inside the margin of a stop, with its sign."""
    return min(x - wishes.low[k], 0.0) + max(x - wishes.high[k], 0.0)


@inner
def _lack(wishes, values):
    """Share of the manipulability that is enough by which that of a sample falls short of it."""
    return max(1.0 - values[MANIPULABILITY] / wishes.enough, 0.0)


@inner
def _wished(wishes, motion, values):
    """Half the squares of what only costs a little."""
    total = wishes.singular * _lack(wishes, values) ** 2
    for k in range(motion.shape[1]):
        total += wishes.motion[1, k] * motion[1, k] ** 2
        total += wishes.motion[2, k] * motion[2, k] ** 2
        total += wishes.stop[k] * _beyond(wishes, k, motion[0, k]) ** 2
    for k in range(3):
        total += wishes.turn * values[TURN + k] ** 2
    return 0.5 * total


@inner
def _one_sample(model, around, bounds, wishes, mu, rho, motion, aim, wanted, values):
    """The share of one sample in the cost, without its weight."""
    thrust, close = around.shares.shape[0] > 0, around.margins.shape[0] > 0
    sample_values(
        model, around.shares, around.current, around.shapes, around.margins,
        motion, aim, wanted, True, thrust, close, values,
    )  # fmt: skip
    total = _wished(wishes, motion, values)
    for k in range(WRENCHES):
        total += 0.5 * values[k] ** 2
    for j in range(bounds.lower.shape[0]):
        v = max(values[WRENCHES + j], bounds.floor[j])
        if bounds.upper[j] < np.inf:
            total += penalty((v - bounds.upper[j]) / bounds.scale[j], mu, rho * bounds.price[j])[0]
        if bounds.lower[j] > -np.inf:
            total += penalty((bounds.lower[j] - v) / bounds.scale[j], mu, rho * bounds.price[j])[0]
    return total


@inner
def _row_value(rows, r, coefficients):
    total = 0.0
    for j in range(3):
        if rows.factors[r, j] != 0.0:
            total += rows.factors[r, j] * coefficients[rows.first[r] + j, rows.dimension[r]]
    return total


@inner
def _row_cost(rows, r, coefficients, mu, rho):
    """Penalty of a linear limit."""
    v, total = _row_value(rows, r, coefficients), 0.0
    if rows.upper[r] < np.inf:
        total += penalty((v - rows.upper[r]) / rows.scale[r], mu, rho)[0]
    if rows.lower[r] > -np.inf:
        total += penalty((rows.lower[r] - v) / rows.scale[r], mu, rho)[0]
    return rows.weights[r] * total


@inner
def _row_slope(rows, r, coefficients, mu, rho, memory):
    """Slope and curvature of a linear limit, by its value."""
    v, scale = _row_value(rows, r, coefficients), rows.scale[r]
    slope, curvature = 0.0, 0.0
    if rows.upper[r] < np.inf:
        z, c = linearised((v - rows.upper[r]) / scale, mu, rho, memory, r, 0, 0)
        slope, curvature = z / scale, c / scale**2
    if rows.lower[r] > -np.inf:
        z, c = linearised((rows.lower[r] - v) / scale, mu, rho, memory, r, 0, 2)
        slope, curvature = slope - z / scale, curvature + c / scale**2
    return rows.weights[r] * slope, rows.weights[r] * curvature


@kernel
def cost(model, around, grid, target, bounds, rows, wishes, mu, rho, coefficients):
    """F(c) for coefficients (K, d)."""
    motion = np.empty((3, coefficients.shape[1]))
    values = np.zeros(WRENCHES + bounds.lower.shape[0])
    aim, wanted = np.empty((3, 3)), np.empty((WANTED_ROWS, 3))
    total = 0.0
    for i in range(grid.first.shape[0]):
        _posture(grid, coefficients, i, motion)
        read_aim(target, i, aim, wanted)
        one = _one_sample(model, around, bounds, wishes, mu, rho, motion, aim, wanted, values)
        total += grid.weights[i] * one
    for r in range(rows.first.shape[0]):
        total += _row_cost(rows, r, coefficients, mu, rho)
    return total


@kernel
def disturbance(model, around, grid, target, bounds, coefficients):
    """J: the integral of the squared wrenches."""
    motion = np.empty((3, coefficients.shape[1]))
    values = np.zeros(WRENCHES + bounds.lower.shape[0])
    aim, wanted = np.empty((3, 3)), np.empty((WANTED_ROWS, 3))
    total = 0.0
    for i in range(grid.first.shape[0]):
        _posture(grid, coefficients, i, motion)
        read_aim(target, i, aim, wanted)
        sample_values(
            model, around.shares, around.current, around.shapes, around.margins,
            motion, aim, wanted, True, False, False, values,
        )  # fmt: skip
        for k in range(WRENCHES):
            total += grid.weights[i] * values[k] ** 2
    return total


@inner
def _add_square(rows, k, factor, slope, matrix, vector):
    """Matrix += factor row^T row, vector += slope row, with row k of `rows`."""
    for a in range(vector.shape[0]):
        x = factor * rows[k, a]
        vector[a] += slope * rows[k, a]
        for b in range(vector.shape[0]):
            matrix[a, b] += x * rows[k, b]


@inner
def _local(bounds, wishes, mu, rho, memory, i, weight, motion, values, jacobian, matrix, vector):
    """Matrix (3d, 3d) and gradient (3d,) of one sample in terms of its motion."""
    d = motion.shape[1]
    matrix[:] = 0.0
    vector[:] = 0.0
    for k in range(WRENCHES):
        _add_square(jacobian, k, weight, weight * values[k], matrix, vector)
    if wishes.turn > 0.0:
        for k in range(3):
            w = weight * wishes.turn
            _add_square(jacobian, TURN + k, w, w * values[TURN + k], matrix, vector)
    lack = _lack(wishes, values)
    if lack > 0.0:
        w, slope = weight * wishes.singular, -1.0 / wishes.enough
        _add_square(jacobian, MANIPULABILITY, w * slope**2, w * slope * lack, matrix, vector)
    for j in range(bounds.lower.shape[0]):
        v, scale = values[WRENCHES + j], bounds.scale[j]
        slope, curvature = 0.0, 0.0
        price = rho * bounds.price[j]
        if v < bounds.floor[j]:
            continue
        if bounds.upper[j] < np.inf:
            z, c = linearised((v - bounds.upper[j]) / scale, mu, price, memory, i, j, 0)
            slope, curvature = z / scale, c / scale**2
        if bounds.lower[j] > -np.inf:
            z, c = linearised((bounds.lower[j] - v) / scale, mu, price, memory, i, j, 2)
            slope, curvature = slope - z / scale, curvature + c / scale**2
        if curvature > 0.0:
            _add_square(jacobian, WRENCHES + j, weight * curvature, weight * slope, matrix, vector)
    for k in range(d):
        for row in range(1, 3):
            w = weight * wishes.motion[row, k]
            matrix[row * d + k, row * d + k] += w
            vector[row * d + k] += w * motion[row, k]
        beyond = _beyond(wishes, k, motion[0, k])
        if beyond != 0.0:
            matrix[k, k] += weight * wishes.stop[k]
            vector[k] += weight * wishes.stop[k] * beyond


@inner
def _spread(grid, i, matrix, vector, half, band, gradient):
    """Add a sample's matrix and gradient to those of the coefficients."""
    size = vector.shape[0]
    d = size // 3
    basis, first, numbers = grid.basis, grid.first[i], grid.numbers
    for a in range(FUNCTIONS):
        column_block = numbers[first + a]
        if column_block < 0:
            continue
        for j in range(d):
            column = column_block * d + j
            x0, x1, x2 = basis[i, 0, a], basis[i, 1, a], basis[i, 2, a]
            gradient[column] += x0 * vector[j] + x1 * vector[d + j] + x2 * vector[2 * d + j]
            for k in range(size):
                half[k] = x0 * matrix[j, k] + x1 * matrix[d + j, k] + x2 * matrix[2 * d + j, k]
            for b in range(FUNCTIONS):
                row_block = numbers[first + b]
                if row_block < column_block:
                    continue
                x0, x1, x2 = basis[i, 0, b], basis[i, 1, b], basis[i, 2, b]
                begin = row_block * d - column
                for m in range(max(-begin, 0), d):
                    band[column, begin + m] += (
                        x0 * half[m] + x1 * half[d + m] + x2 * half[2 * d + m]
                    )


@inner
def _near_a_limit(around, bounds, values):
    """Whether a thruster's share is so great that its derivatives count."""
    for k in range(THRUST, THRUST + around.shares.shape[0]):
        if values[k] > bounds.floor[k - WRENCHES]:
            return True
    return False


@inner
def _near_a_body(around, values):
    """Whether a clearance is so small that its derivatives count."""
    first = THRUST + around.shares.shape[0]
    for k in range(around.margins.shape[0]):
        if values[first + k] < around.margins[k] + NEAR_M:
            return True
    return False


@inner
def _forget(around, needed, near, jacobian):
    """Clear the derivatives that were not taken."""
    first = THRUST + around.shares.shape[0]
    if not needed:
        jacobian[THRUST:first] = 0.0
    if not near:
        jacobian[first:] = 0.0


@kernel
def linearise(
    model,
    around,
    grid,
    target,
    bounds,
    rows,
    wishes,
    mu,
    rho,
    coefficients,
    memory,
    row_memory,
    band,
):
    """Gradient of F; fills `band` (unknowns, width) with its Gauss-Newton matrix.

    memory (k, v, 4) and row_memory (r, 1, 4) hold what `barrier.linearised` remembers.
    Row c of the band holds the elements (c, c), (c + 1, c) ... of column c.
    """
    d = coefficients.shape[1]
    motion, size = np.empty((3, d)), WRENCHES + bounds.lower.shape[0]
    values, moved, jacobian = np.zeros(size), np.zeros(size), np.zeros((size, 3 * d))
    matrix, vector = np.empty((3 * d, 3 * d)), np.empty(3 * d)
    half, aim, wanted = np.empty(3 * d), np.empty((3, 3)), np.empty((WANTED_ROWS, 3))
    gradient = np.zeros(band.shape[0])
    band[:] = 0.0
    for i in range(grid.first.shape[0]):
        _posture(grid, coefficients, i, motion)
        read_aim(target, i, aim, wanted)
        thrust, close = around.shares.shape[0] > 0, around.margins.shape[0] > 0
        sample_values(
            model, around.shares, around.current, around.shapes, around.margins,
            motion, aim, wanted, True, thrust, close, values,
        )  # fmt: skip
        needed = _near_a_limit(around, bounds, values)
        near = _near_a_body(around, values)
        sample_jacobian(
            model, around.shares, around.current, around.shapes, around.margins,
            motion, aim, wanted, needed, near, values, moved, jacobian,
        )  # fmt: skip
        _forget(around, needed, near, jacobian)
        _local(
            bounds,
            wishes,
            mu,
            rho,
            memory,
            i,
            grid.weights[i],
            motion,
            values,
            jacobian,
            matrix,
            vector,
        )
        _spread(grid, i, matrix, vector, half, band, gradient)
    for r in range(rows.first.shape[0]):
        _add_row(grid, rows, r, mu, rho, row_memory, coefficients, band, gradient)
    return gradient


@inner
def _add_row(grid, rows, r, mu, rho, memory, coefficients, band, gradient):
    d = coefficients.shape[1]
    slope, curvature = _row_slope(rows, r, coefficients, mu, rho, memory)
    for j in range(3):
        column_block = grid.numbers[rows.first[r] + j]
        if rows.factors[r, j] == 0.0 or column_block < 0:
            continue
        column = column_block * d + rows.dimension[r]
        gradient[column] += slope * rows.factors[r, j]
        for k in range(3):
            if rows.factors[r, k] == 0.0:
                continue
            row_block = grid.numbers[rows.first[r] + k]
            if row_block >= column_block:
                factor = rows.factors[r, j] * rows.factors[r, k]
                band[column, (row_block - column_block) * d] += curvature * factor
