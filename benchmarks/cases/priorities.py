"""Allocation by priorities: against sequences of quadprog and daqp, daqp's own levels; one step."""

import time
from collections.abc import Callable, Iterator

import daqp
import numpy as np
import quadprog
from metrics import Metric, Target
from paired import paired

from uvms_control import AllocatorConfig, ThrustAllocator
from uvms_control.allocation import LexicographicLeastSquares
from uvms_core.signals import Array, Wrench
from uvms_core.vehicle import load_vehicle

COUNT = 64
SOME, ALL = 1000, 10_000
"""Wrenches whose optimum is compared; all with `--full`."""
PROXIMAL, SLACK = 1e-5, 1e-11
"""A level alone is not strictly convex; and rounding may leave nothing of what is left to it."""
TICK = 50_000_000

Program = Callable[[Array, Array, Array, Array, Array, Array], Array]


class Problem:
    """The reference vehicle's, in shares of the thrust limits."""

    def __init__(self) -> None:
        self.allocator = ThrustAllocator(load_vehicle(), AllocatorConfig(lag_compensation=0.0))
        self.gross = np.abs(self.allocator.matrix) @ self.allocator.limits
        solver = self.allocator._solver
        assert isinstance(solver, LexicographicLeastSquares)
        self.solver, (self.rows, self.ends, self.axes, self.scale, self.limits, _) = (
            solver,
            solver._problem,
        )
        self.box = np.vstack([self.allocator.lower, self.allocator.upper])
        self.low, self.high = self.box / self.limits
        self.breaks = np.append(len(self.limits), len(self.limits) + self.ends).astype(np.int32)
        self.senses = np.zeros(len(self.limits) + len(self.rows), dtype=np.int32)

    def ours(self, tau: Array) -> Array:
        """Thrusts, N."""
        return self.solver.solve(tau, *self.box)

    def sequence(self, tau: Array, program: Program, most: int) -> Array:
        """A program a level, the levels above as equalities, at most so often until it stands."""
        target, m = (self.scale * tau)[self.axes], len(self.limits)
        rows, values, u, first = np.zeros((0, m)), np.zeros(0), np.zeros(m), 0
        for end in self.ends:
            a, b = self.rows[first:end], target[first:end]
            hessian = a.T @ a + PROXIMAL * np.eye(m)
            for _ in range(most):
                last, linear = u, a.T @ b + PROXIMAL * u
                u = program(hessian, linear, rows, values, self.low, self.high)
                if np.abs(u - last).max() < 1e-12:
                    break
            rows, values, first = np.vstack([rows, a]), np.append(values, a @ u), end
        return self.limits * program(np.eye(m), np.zeros(m), rows, values, self.low, self.high)

    def daqp_levels(self, tau: Array, tolerance: float = 1e-9) -> Array:
        """Daqp's hierarchy of soft constraints, in one call."""
        target = (self.scale * tau)[self.axes]
        upper, lower = np.append(self.high, target), np.append(self.low, target)
        return self.limits * daqp.solve(
            None, None, self.rows, upper, lower, self.senses, break_points=self.breaks,
            primal_tol=tolerance,
        )[0]  # fmt: skip


def by_quadprog(hessian, linear, rows, values, low, high):
    """One level by Goldfarb and Idnani's method."""
    eye = np.eye(len(linear))
    try:
        sides = np.concatenate([values, low, -high])
        return quadprog.solve_qp(
            hessian, linear, np.vstack([rows, eye, -eye]).T, sides, len(values)
        )[0]
    except ValueError:  # inconsistent by rounding
        sides = np.concatenate([values - SLACK, -values - SLACK, low, -high])
        return quadprog.solve_qp(hessian, linear, np.vstack([rows, -rows, eye, -eye]).T, sides)[0]


def by_daqp(hessian, linear, rows, values, low, high):
    """One level by a dual active-set method."""
    sense = np.array([0] * len(low) + [5] * len(values), dtype=np.int32)
    found = daqp.solve(
        hessian, -linear, np.ascontiguousarray(rows), np.append(high, values),
        np.append(low, values), sense, primal_tol=1e-9, dual_tol=1e-12,
    )  # fmt: skip
    return found[0] if found[2] > 0 else by_quadprog(hessian, linear, rows, values, low, high)


def measure(full: bool) -> Iterator[Metric]:
    """Wrenches of which half or more saturate; time and difference in the wrench, N and N m."""
    problem, rng = Problem(), np.random.default_rng(1)
    wrenches = rng.uniform(-1.0, 1.0, (ALL if full else SOME, 6)) * problem.gross
    halves = wrenches * np.where(np.arange(len(wrenches)) % 2, 1.0, 0.25)[:, None]
    references: dict[str, tuple[str, Callable[[Array], Array]]] = {
        "quadprog": ("a program a level", lambda tau: problem.sequence(tau, by_quadprog, 40)),
        "daqp": ("a program a level", lambda tau: problem.sequence(tau, by_daqp, 40)),
        "daqp_levels": ("break_points, primal_tol 1e-9", problem.daqp_levels),
    }
    for name, (text, solve) in references.items():
        matrix = problem.allocator.matrix
        worst = max(np.abs(matrix @ (problem.ours(tau) - solve(tau))).max() for tau in halves)
        yield Metric(
            f"priorities_difference_{name}", float(worst), "N", f"{text}, {len(halves)}"
            " wrenches", None, Target("value", "<=", 1e-6),
        )  # fmt: skip
    timed = halves[:COUNT]
    once: dict[str, Callable[[Array], Array]] = {
        "quadprog": lambda tau: problem.sequence(tau, by_quadprog, 1),
        "daqp": lambda tau: problem.sequence(tau, by_daqp, 1),
        "daqp_levels": problem.daqp_levels,
    }
    timing = paired(
        _through(problem.ours, timed),
        {name: _through(solve, timed) for name, solve in once.items()},
        rounds=21,
    )
    for name, ratio in timing.ratio.items():
        yield Metric(
            f"priorities_against_{name}", 1e6 * timing.seconds / COUNT, "us",
            f"{references[name][0]}, cold, once a level", ratio,
            Target("ratio", "<=", 0.6 if name == "quadprog" else 1.0),
        )  # fmt: skip
    for share in (0.0, AllocatorConfig().lag_compensation):
        allocator = ThrustAllocator(load_vehicle(), AllocatorConfig(lag_compensation=share))
        yield Metric(
            f"allocator_step_lag_{share:g}", 1e6 * _step(allocator, halves), "us",
            "processor time, a signal in and one out", None, Target("value", "<=", 20.0),
        )  # fmt: skip


def _through(solve, wrenches):
    def work() -> None:
        for tau in wrenches:
            solve(tau)

    return work


def _step(allocator: ThrustAllocator, wrenches: Array) -> float:
    """Least mean time of a step in blocks of COUNT, s."""
    times = []
    for first in range(0, len(wrenches) - COUNT, COUNT):
        signals = [Wrench((first + k) * TICK, wrenches[first + k]) for k in range(COUNT)]
        began = time.process_time()
        for signal in signals:
            allocator.step(signal)
        times.append((time.process_time() - began) / COUNT)
    return min(times[1:])
