"""The problem on knots: what the kernels of `assembly` take."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.interpolate import make_interp_spline

from uvms_core.signals import Array
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path import assembly
from uvms_planner.whole_path.assembly import Bounds, Grid, Rows, Wishes
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.sample import Surroundings, Target
from uvms_planner.whole_path.sampled_bounds import sampled_bounds
from uvms_planner.whole_path.spline import (
    DEGREE,
    FIXED,
    basis_at,
    end_coefficients,
    greville,
    knots_at,
    last_coefficients,
    rate_factors,
)

TIGHT = 0.99  # of sampled limits: what a value may gain between two samples


@dataclass(frozen=True)
class Discrete:
    """A problem on knots."""

    problem: PathProblem
    knots: Array
    times: Array  # (k,) s, of the samples
    grid: Grid
    target: Target
    around: Surroundings
    bounds: Bounds
    rows: Rows
    wishes: Wishes

    @property
    def unknowns(self) -> int:
        """How many numbers are sought."""
        return (int(self.grid.numbers.max()) + 1) * self.problem.size

    def arguments(self):
        """The first arguments of the kernels."""
        return (
            self.problem.model, self.around, self.grid, self.target, self.bounds, self.rows,
            self.wishes,
        )  # fmt: skip

    def tightened(self, excess: Array) -> "Discrete":
        """The same with the sampled limits less by the shares `excess` (v,) where positive."""
        less = np.maximum(excess, 0.0) * self.bounds.scale
        bounds = self.bounds._replace(
            lower=self.bounds.lower + less, upper=self.bounds.upper - less
        )
        return replace(self, bounds=bounds)

    def taken_from(self, knots: Array, coefficients: Array) -> Array:
        """Coefficients (K, d) of the spline on these knots that is nearest to one on others."""
        sites = np.clip(greville(self.knots), knots[0], knots[-1])
        basis = basis_at(knots, sites)
        near = coefficients[basis.first[:, None] + np.arange(DEGREE + 1)]
        values = np.einsum("ka,kad->kd", basis.values[:, 0], near)
        return self.complete(make_interp_spline(sites, values, k=DEGREE, t=self.knots).c)

    def disturbance(self, coefficients: Array) -> float:
        """J on the samples of the quadrature."""
        return assembly.disturbance(
            self.problem.model, self.around, self.grid, self.target, self.bounds, coefficients
        )

    def complete(self, coefficients: Array) -> Array:
        """The same coefficients (K, d) with those at both ends put right."""
        out, start, end = coefficients.copy(), self.problem.start, self.problem.end
        out[:FIXED] = end_coefficients(self.knots, start.value, start.rate, start.acceleration)
        if end is None:
            out[-FIXED:] = out[-FIXED]
        else:
            out[-FIXED:] = last_coefficients(self.knots, end.value, end.rate, end.acceleration)
        return out


def discretise(
    problem: PathProblem, breaks: Array, points: int = 3, tight: float = TIGHT
) -> Discrete:
    """The problem with the spline's pieces between `breaks` and `points` samples on each."""
    knots = knots_at(breaks)
    times, weights = _quadrature(breaks, points)
    basis = basis_at(knots, times)
    count = len(knots) - DEGREE - 1
    numbers = np.arange(count) - FIXED
    numbers[:FIXED], numbers[-FIXED:] = -1, count - 2 * FIXED if problem.end is None else -1
    grid = Grid(basis.first, basis.values, weights, numbers.astype(np.int64))
    return Discrete(
        problem, knots, times, grid, problem.target(times), problem.around,
        sampled_bounds(problem, tight), _rows(problem, knots, numbers), _wishes(problem),
    )  # fmt: skip


def _quadrature(breaks: Array, points: int) -> tuple[Array, Array]:
    """Gauss-Legendre instants and weights on every piece."""
    x, w = np.polynomial.legendre.leggauss(points)
    half, middle = np.diff(breaks) / 2, (breaks[1:] + breaks[:-1]) / 2
    return (middle[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def _rows(problem: PathProblem, knots: Array, numbers: Any) -> Rows:
    """Bounds, rates and accelerations of the posture by the convex hull of the coefficients."""
    first, second = rate_factors(knots, DEGREE), rate_factors(knots[1:-1], DEGREE - 1)
    zero = np.zeros_like(first)
    value = np.stack([np.ones(len(numbers)), np.zeros(len(numbers)), np.zeros(len(numbers))], 1)
    rate = np.stack([-first, first, zero], 1)
    bend = np.stack(
        [second * first[:-1], -second * (first[:-1] + first[1:]), second * first[1:]], 1
    )
    parts = []
    for k in range(problem.size):
        c, limits = VEHICLE - 1 + k, problem.limits
        low = min(limits.lower[c], problem.start.value[k])
        high = max(limits.upper[c], problem.start.value[k])
        parts.append(_row_block(k, value, knots, DEGREE, low, high, numbers))
        for factors, degree, top in ((rate, 3, limits.rate[c]), (bend, 2, limits.acceleration[c])):
            parts.append(_row_block(k, factors, knots, degree, -top, top, numbers))
    return Rows(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _row_block(k, factors, knots, degree, low, high, numbers):
    """One limit of posture variable k for all coefficients of one derivative."""
    drop = DEGREE - degree
    own = knots[drop : len(knots) - drop]
    span = (own[degree + 1 :] - own[: -degree - 1]) / (degree + 1)
    first = np.arange(len(factors))
    free = np.array([(numbers[i : i + drop + 1] >= 0).any() for i in first])
    moves = np.array([len(set(numbers[i : i + drop + 1])) > 1 for i in first]) | (drop == 0)
    used = free & moves & bool(np.isfinite(low) or np.isfinite(high))
    count = int(used.sum())
    half = (high - low) / 2 if np.isfinite(high - low) else 1.0
    return (
        first[used].astype(np.int64), np.full(count, k, dtype=np.int64),
        np.ascontiguousarray(factors[used]), np.full(count, float(low)),
        np.full(count, float(high)), np.full(count, half), span[used],
    )  # fmt: skip


def _wishes(problem: PathProblem) -> Wishes:
    weights, limits, d = problem.weights, problem.limits, problem.size
    rate, bend = limits.rate[VEHICLE - 1 :], limits.acceleration[VEHICLE - 1 :]
    lower, upper = limits.lower[VEHICLE - 1 :], limits.upper[VEHICLE - 1 :]
    motion = np.stack([np.zeros(d), weights.rate / rate**2, weights.acceleration / bend**2])
    margin = np.minimum(weights.stop_margin, (upper - lower) / 4)
    stop = np.where(np.isfinite(upper - lower), weights.stop / weights.stop_margin**2, 0.0)
    enough = weights.manipulability * problem.best_manipulability
    singular, enough = (weights.singular, enough) if enough > 0.0 else (0.0, 1.0)
    return Wishes(
        motion, lower + margin, upper - margin, stop,
        problem.turn_weight, singular, enough,
    )  # fmt: skip
