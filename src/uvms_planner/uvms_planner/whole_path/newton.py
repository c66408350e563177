"""Damped Gauss-Newton steps with a banded Cholesky factor, the barrier lowered on the way."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from uvms_core.signals import Array
from uvms_planner.whole_path import assembly
from uvms_planner.whole_path.assembly import FUNCTIONS
from uvms_planner.whole_path.discrete import Discrete

SUFFICIENT = 0.1  # share of the predicted decrease that a step must bring


@dataclass(frozen=True)
class Schedule:
    """How the barrier is lowered."""

    first: float = 1e-1
    last: float = 1e-5
    factor: float = 0.1
    price: float = 1e3  # rho of a broken limit
    steps: int = 4  # at most for one barrier
    final_steps: int = 12
    tolerance: float = 1e-5  # decrease, relative to the cost, below which it has converged


@dataclass(frozen=True)
class Solution:
    """Coefficients (K, d), the cost F and the steps taken."""

    coefficients: Array
    cost: float
    iterations: int


def solve_on_knots(discrete: Discrete, start: Array, schedule: Schedule, tick=lambda: None):
    """A local optimum from coefficients `start` (K, d)."""
    c, mu, damping, count = discrete.complete(start), schedule.first, 1e-4, 0
    while True:
        final = mu <= schedule.last * 1.001
        value = assembly.cost(*discrete.arguments(), mu, schedule.price, c)
        for _ in range(schedule.final_steps if final else schedule.steps):
            c, new, damping, predicted = step(discrete, c, value, mu, schedule.price, damping)
            count += 1
            tick()
            gained, value = value - new, new
            if max(gained, 0.0) <= schedule.tolerance * abs(value) and predicted <= 10 * (
                schedule.tolerance * abs(value)
            ):
                break
        if final:
            return Solution(c, value, count)
        mu = max(mu * schedule.factor, schedule.last)


def step(discrete: Discrete, c: Array, value: float, mu: float, price: float, damping: float):
    """One step: new coefficients, their cost, the next damping, the decrease that was predicted."""
    d = discrete.problem.size
    band = np.empty((discrete.unknowns, FUNCTIONS * d))
    arguments = (*discrete.arguments(), mu, price)
    gradient = assembly.linearise(*arguments, c, band)
    diagonal = band[:, 0].copy()
    for _ in range(8):
        band[:, 0] = diagonal * (1 + damping) + 1e-12
        try:
            move = solveh_banded(band.T, -gradient, lower=True, check_finite=False)
        except LinAlgError:
            damping = max(10 * damping, 1e-6)
            continue
        slope = float(gradient @ move)
        length = 1.0
        for _ in range(4):
            new = moved(discrete, c, length * move)
            cost = assembly.cost(*arguments, new)
            if cost <= value + SUFFICIENT * length * slope:
                damping = damping * (0.1 if length == 1.0 else 2.0)
                return new, cost, max(damping, 1e-9), -slope
            length *= 0.4
        damping = max(30 * damping, 1e-6)
    return c, value, damping, -slope


def moved(discrete: Discrete, c: Array, move: Array) -> Array:
    """Coefficients with the unknowns moved."""
    blocks = np.vstack([move.reshape(-1, discrete.problem.size), np.zeros((1, c.shape[1]))])
    return c + blocks[discrete.grid.numbers]
