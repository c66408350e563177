"""Thrust allocation: the active-set kernel against scipy's lsq_linear, daqp and quadprog."""

from collections.abc import Iterator

import daqp
import numpy as np
import quadprog
from metrics import Metric, Target
from paired import paired
from scipy.optimize import lsq_linear

from uvms_control import AllocatorConfig
from uvms_control.allocation.least_squares import BoundedLeastSquares
from uvms_core.signals import Array
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix

COUNT = 64
AGREEMENT = 1e-6
"""Relative amount by which an objective may exceed the best of all solvers."""


class Problem:
    """The allocator's problem in scaled thrusts u, |u| <= 1: min 1/2 u^T H u + g^T u."""

    def __init__(self) -> None:
        vehicle, config = load_vehicle(), AllocatorConfig()
        limits = np.array([thruster.greatest_n for thruster in vehicle.thrusters])
        matrix, m = thruster_matrix(vehicle), len(limits)
        authority = np.abs(matrix) @ limits
        self.scale = np.array(config.weights) / authority
        self.solver = BoundedLeastSquares(
            matrix, limits, np.array(config.weights), config.regularisation
        )
        self.limits = limits
        scaled = self.scale[:, None] * matrix * limits
        self.stacked = np.vstack([scaled, np.sqrt(config.regularisation) * np.eye(m)])
        self.hessian = np.ascontiguousarray(self.stacked.T @ self.stacked)
        self.box = np.ascontiguousarray(np.hstack([np.eye(m), -np.eye(m)]))
        self.rows = np.zeros((0, m))
        self.wrenches = _wrenches(authority)

    def gradient(self, tau: Array) -> Array:
        """Linear term g of the objective."""
        return -self.stacked[:6].T @ (self.scale * tau)

    def ours(self, tau: Array) -> Array:
        """Warm started from the wrench before, as in the loop."""
        return self.solver.solve(tau) / self.limits

    def scipy(self, tau: Array) -> Array:
        """Bounded-variable least squares on the stacked rows."""
        m = len(self.limits)
        target = np.concatenate([self.scale * tau, np.zeros(m)])
        return lsq_linear(self.stacked, target, (-1.0, 1.0), method="bvls").x

    def daqp(self, tau: Array) -> Array:
        """Dual active-set method in C."""
        m = len(self.limits)
        sense = np.zeros(m, dtype=np.int32)
        return daqp.solve(
            self.hessian, self.gradient(tau), self.rows, np.ones(m), -np.ones(m), sense
        )[0]

    def quadprog(self, tau: Array) -> Array:
        """Goldfarb and Idnani's method in C."""
        return quadprog.solve_qp(
            self.hessian, -self.gradient(tau), self.box, -np.ones(2 * len(self.limits))
        )[0]

    def objective(self, u: Array, tau: Array) -> float:
        """What is minimised."""
        return float(0.5 * u @ self.hessian @ u + self.gradient(tau) @ u)


def measure(full: bool) -> Iterator[Metric]:
    """Wrenches that change slowly, some of them beyond the thrusters' limits."""
    problem = Problem()
    names = {
        "scipy": "scipy.optimize.lsq_linear, bvls",
        "daqp": "daqp.solve, cold",
        "quadprog": "quadprog.solve_qp, cold",
    }
    _check(problem, names)
    timing = paired(
        _through(problem, "ours"), {name: _through(problem, name) for name in names}, rounds=21
    )
    for name, text in names.items():
        yield Metric(
            f"allocation_against_{name}", 1e6 * timing.seconds / COUNT, "us", text,
            timing.ratio[name], Target("ratio", "<=", 1.0),
        )  # fmt: skip


def _through(problem: Problem, name: str):
    solve = getattr(problem, name)

    def work() -> None:
        for tau in problem.wrenches:
            solve(tau)

    return work


def _check(problem: Problem, names) -> None:
    for tau in problem.wrenches:
        found = [problem.objective(getattr(problem, name)(tau), tau) for name in ("ours", *names)]
        if max(found) - min(found) > AGREEMENT * max(1.0, -min(found)):
            raise ArithmeticError(f"the solvers do not agree for {tau}: {found}")


def _wrenches(authority: Array) -> Array:
    """A random walk (COUNT, 6) through and beyond what the thrusters can do."""
    steps = np.random.default_rng(1).normal(scale=0.05, size=(COUNT, 6)).cumsum(axis=0)
    return steps * authority
