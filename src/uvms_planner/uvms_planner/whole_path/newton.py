"""Damped Gauss-Newton steps with a banded Cholesky factor, the barrier lowered on the way."""

from collections.abc import Callable, Generator
from dataclasses import dataclass, replace
from typing import TypeVar, cast

import numpy as np
from scipy.linalg import LinAlgError, solveh_banded

from uvms_core.signals import Array
from uvms_planner.whole_path import assembly
from uvms_planner.whole_path.assembly import FUNCTIONS
from uvms_planner.whole_path.discrete import Discrete

PLENTY = 0.5  # share of the promised decrease at which a step is not shortened
SHORTER = 0.75  # from one length of a step to the next
FIRST_DAMPING = 1e-4  # of the diagonal, Marquardt's
LOOSER = 20.0  # tolerance while the barrier is still to be lowered
TINY = 1e-12  # added to the diagonal
TRIES = 8  # dampings, and for each
LENGTHS = 12  # of a step

T = TypeVar("T")


@dataclass(frozen=True)
class Schedule:
    """How the barrier is lowered."""

    barriers: tuple[float, ...] = (1e-1, 1e-2, 1e-3, 1e-4)
    price: float = 1e3  # rho of a broken limit, N^2 (N^2 m^2) for a whole limit
    steps: int = 5  # at most for one barrier
    final_steps: int = 8
    tolerance: float = 1e-4  # gain, relative to the disturbance, below which it has converged

    @property
    def most_steps(self) -> int:
        """Steps that it takes at most."""
        return self.steps * (len(self.barriers) - 1) + self.final_steps

    def scaled(self, factor: float) -> "Schedule":
        """The same for costs that are `factor` times as large."""
        barriers = tuple(factor * barrier for barrier in self.barriers)
        return replace(self, barriers=barriers, price=factor * self.price)

    def at_price(self, price: float) -> "Schedule":
        """The same with another price."""
        return replace(self, price=price)


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
            here = -0.5 * float(gradient @ move)
            promised = max(promised, here)
            gained = self._search(move, value, here, mu)
            if gained is not None:
                return gained, promised
            self.damping = max(10 * self.damping, 1e-6)
        self.forget()
        self.damping = FIRST_DAMPING
        return 0.0, promised

    def _search(self, move: Array, value: float, promised: float, mu: float) -> float | None:
        """Go along `move` as far as it helps most; what was gained, None for nowhere."""
        length, best = 1.0, (0.0, 0.0, self.coefficients)
        for _ in range(LENGTHS):
            new = moved(self.discrete, self.coefficients, length * move)
            gained = value - self.cost(mu, new)
            if gained < best[0]:
                break
            if gained > 0.0:
                best = (gained, length, new)
            if gained >= PLENTY * length * promised:
                break
            length *= SHORTER
        gained, length, new = best
        if length == 0.0:
            return None
        self.damping = max(self.damping * (0.03 if length > 0.6 else 2.0), 1e-9)
        self.coefficients = new
        return gained


def solve_on_knots(discrete: Discrete, start: Array, schedule: Schedule, tick=lambda: None):
    """A local optimum from coefficients `start` (K, d)."""
    return finished(newton_steps(discrete, start, schedule), tick)


def finished(steps: Generator[None, None, T], tick: Callable[[], None] = lambda: None) -> T:
    """What a search returns that is done step by step, with `tick` called after each."""
    while True:
        try:
            next(steps)
        except StopIteration as end:
            return cast(T, end.value)
        tick()


def newton_steps(
    discrete: Discrete, start: Array, schedule: Schedule
) -> Generator[None, None, Solution]:
    """The same, one step at a time; the optimum is what it returns."""
    point, count = Iteration(discrete, start, schedule.price), 0
    for number, mu in enumerate(schedule.barriers):
        final = number == len(schedule.barriers) - 1
        for _ in range(schedule.final_steps if final else schedule.steps):
            gained, promised = point.step(mu)
            count += 1
            yield
            scale = 0.5 * discrete.disturbance(point.coefficients)
            tolerance = schedule.tolerance * (1 if final else LOOSER)
            if max(gained, promised) <= tolerance * scale:
                break
    return Solution(point.coefficients, point.cost(mu), count)


def moved(discrete: Discrete, c: Array, move: Array) -> Array:
    """Coefficients with the unknowns moved."""
    blocks = np.vstack([move.reshape(-1, discrete.problem.size), np.zeros((1, c.shape[1]))])
    return c + blocks[discrete.grid.numbers]
