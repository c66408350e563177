"""Damped Gauss-Newton steps with a banded Cholesky factor, the barrier lowered on the way."""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from uvms_core.signals import Array
from uvms_planner.whole_path import assembly
from uvms_planner.whole_path.assembly import FUNCTIONS
from uvms_planner.whole_path.discrete import Discrete

SUFFICIENT = 0.01  # share of the promised decrease that a step must bring
FIRST_DAMPING = 1e-4  # of the diagonal, Marquardt's
TINY = 1e-12  # added to the diagonal
TRIES = 8  # dampings, and for each
HALVINGS = 4  # lengths of a step


@dataclass(frozen=True)
class Schedule:
    """How the barrier is lowered."""

    first: float = 1e-1
    last: float = 1e-5
    factor: float = 0.1
    price: float = 1e3  # rho of a broken limit
    steps: int = 6  # at most for one barrier
    final_steps: int = 12
    tolerance: float = 1e-4  # decrease, relative to the cost, below which it has converged


@dataclass(frozen=True)
class Solution:
    """Coefficients (K, d), the cost F and the steps taken."""

    coefficients: Array
    cost: float
    iterations: int


class Iteration:
    """A point of the search with what its next step needs."""

    def __init__(self, discrete: Discrete, start: Array, price: float):
        self.discrete = discrete
        self.coefficients = discrete.complete(start)
        self.price = price
        self.damping = FIRST_DAMPING
        self._memory = np.empty((len(discrete.grid.first), len(discrete.bounds.lower), 4))
        self._row_memory = np.empty((len(discrete.rows.first), 1, 4))
        self.forget()

    def forget(self) -> None:
        """Estimate the multipliers anew from the barrier."""
        self._memory[:, :, ::2] = self._row_memory[:, :, ::2] = -1.0

    def cost(self, mu: float, coefficients: Array | None = None) -> float:
        """F with the barrier mu, here or elsewhere."""
        c = self.coefficients if coefficients is None else coefficients
        return assembly.cost(*self.discrete.arguments(), mu, self.price, c)

    def step(self, mu: float) -> tuple[float, float]:
        """Move on, where that lowers F; what was gained, and what the model promised."""
        discrete, value = self.discrete, self.cost(mu)
        band = np.empty((discrete.unknowns, FUNCTIONS * discrete.problem.size))
        gradient = assembly.linearise(
            *discrete.arguments(), mu, self.price, self.coefficients, self._memory,
            self._row_memory, band,
        )  # fmt: skip
        diagonal, promised = band[:, 0].copy(), 0.0
        for _ in range(TRIES):
            band[:, 0] = diagonal * (1 + self.damping) + TINY
            try:
                move = solveh_banded(band.T, -gradient, lower=True, check_finite=False)
            except LinAlgError:
                self.damping = max(10 * self.damping, 1e-6)
                continue
            promised = -0.5 * float(gradient @ move)
            gained = self._search(move, value, promised, mu)
            if gained is not None:
                return gained, promised
            self.damping = max(30 * self.damping, 1e-6)
        self.forget()
        return 0.0, promised

    def _search(self, move: Array, value: float, promised: float, mu: float) -> float | None:
        """Go along `move` as far as it helps; what was gained, None for nowhere."""
        length = 1.0
        for _ in range(HALVINGS):
            new = moved(self.discrete, self.coefficients, length * move)
            gained = value - self.cost(mu, new)
            if gained >= SUFFICIENT * length * promised:
                self.damping = max(self.damping * (0.1 if length == 1.0 else 2.0), 1e-9)
                self.coefficients = new
                return gained
            length *= 0.4
        return None


def solve_on_knots(discrete: Discrete, start: Array, schedule: Schedule, tick=lambda: None):
    """A local optimum from coefficients `start` (K, d)."""
    point, mu, count = Iteration(discrete, start, schedule.price), schedule.first, 0
    scale = 0.5 * discrete.disturbance(point.coefficients)
    while True:
        final = mu <= schedule.last * 1.001
        for _ in range(schedule.final_steps if final else schedule.steps):
            gained, promised = point.step(mu)
            count += 1
            tick()
            now = 0.5 * discrete.disturbance(point.coefficients)
            scale = min(scale, now)
            if max(gained, promised) <= schedule.tolerance * scale * (1 if final else 100):
                break
        if final:
            return Solution(point.coefficients, point.cost(mu), count)
        mu = max(mu * schedule.factor, schedule.last)


def moved(discrete: Discrete, c: Array, move: Array) -> Array:
    """Coefficients with the unknowns moved."""
    blocks = np.vstack([move.reshape(-1, discrete.problem.size), np.zeros((1, c.shape[1]))])
    return c + blocks[discrete.grid.numbers]
