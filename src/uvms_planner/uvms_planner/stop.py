"""Coming to rest and staying there: before a goal, after its end, and when it is cancelled."""

import numpy as np
from numpy.typing import NDArray

from uvms_core.end_effector_path import PathSample
from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.knot_motion import meet
from uvms_planner.projection import project
from uvms_planner.segment import Knot, Samples, evaluate, hermite, quintic
from uvms_planner.solver import StepSolver

ROUNDING = 1e-9  # share of a limit


class Stop:
    """Brakes from a moving knot and holds; with an `anchor` the end effector stays at it."""

    def __init__(
        self, solver: StepSolver, start: Knot, step: float, anchor: PathSample | None = None
    ):
        self._solver, self._start, self._step, self._anchor = solver, start, step, anchor
        steps = _steps_to_rest(start, solver, step)
        self._rest = start.stamp + int(np.max(steps)) * to_nanoseconds(step)
        # each variable for itself, so that none goes farther than its own deceleration needs
        self._durations = np.maximum(steps, 1) * step
        # the end that makes the rate fall as (1 - u)^2 (1 + 2 u), u = t / duration
        travel = start.rate / 2 + start.acceleration * self._durations / 12
        end = start.configuration + travel * self._durations
        zero = np.zeros_like(end)
        self._coefficients = quintic(
            (start.configuration, start.rate, start.acceleration),
            (end, zero, zero),
            self._durations,
        )

    @property
    def rest(self) -> int:
        """Stamp from which on nothing moves."""
        return self._rest

    def end(self, stamp: int) -> Knot:
        """The first knot at rest that is not before `stamp`."""
        knot, times = self._start, np.array([0.0, self._step])
        while knot.stamp < self.rest:
            knot, _ = self.plan(knot, times)
        return Knot.at_rest(max(stamp, self.rest), knot.configuration)

    def plan(self, knot: Knot, times) -> tuple[Knot, Samples]:
        """The next knot after `knot`, and the motion to it at `times` (k,) s."""
        stamp = knot.stamp + to_nanoseconds(self._step)
        if knot.stamp >= self.rest:
            end = Knot.at_rest(stamp, knot.configuration)
        else:
            end = self._braked(knot, stamp)
        return end, hermite(knot, end, self._step, times)

    def _braked(self, knot: Knot, stamp: int) -> Knot:
        c, rate, acceleration = self._state(to_seconds(stamp - self._start.stamp))
        increment = c - knot.configuration
        if self._anchor is None:
            return Knot(stamp, c, rate, acceleration, increment)
        problem = self._solver.problem(
            knot.configuration,
            knot.increment,
            self._anchor,
            self._solver.limits.rate_increments(knot.configuration),
        )
        project(self._solver.model, problem, increment)
        end, still = knot.configuration + increment, np.zeros(6)
        if stamp < self.rest:
            meet(self._solver.model, problem, end, still, still, rate, acceleration)
        return Knot(stamp, end, rate, acceleration, increment)

    def _state(self, elapsed: float) -> tuple[Array, Array, Array]:
        """Configuration, rate and acceleration (m,) `elapsed` s after the start."""
        times = np.minimum(elapsed, self._durations)
        samples = evaluate(self._coefficients, times)
        parts = samples.configuration, samples.rate, samples.acceleration
        c, rate, acceleration = (np.diagonal(part).copy() for part in parts)
        return c, rate, acceleration


def _steps_to_rest(start: Knot, solver: StepSolver, step: float) -> NDArray[np.int64]:
    """Whole steps (m,) in which each variable can come to rest; 0 for those at rest.

    As many that the acceleration stays within its limit, or within that at the start where that is
    beyond it.
    """
    allowed = np.maximum(solver.motion_limits.acceleration, np.abs(start.acceleration))
    steps = np.zeros(len(start.rate), dtype=np.int64)
    moving = (start.rate != 0.0) | (start.acceleration != 0.0)
    count = 0
    while moving.any():
        count += 1
        steps[moving] = count
        peak = _greatest_acceleration(start.rate / (count * step), start.acceleration)
        moving &= peak > allowed * (1.0 + ROUNDING)
    return steps


def _greatest_acceleration(mean: Array, first: Array) -> Array:
    """Of a stop from the acceleration `first` (m,) by the mean acceleration -`mean` (m,).

    The rate is cubic, so that the acceleration is a parabola of u = t / duration,
    a(u) = a_0 - (4 a_0 + 6 m) u + (3 a_0 + 6 m) u^2, which ends at zero.
    """
    slope, bend = 4 * first + 6 * mean, 3 * first + 6 * mean
    with np.errstate(divide="ignore", invalid="ignore"):
        vertex = slope / (2 * bend)
        value = first - slope**2 / (4 * bend)
    inside = (vertex > 0.0) & (vertex < 1.0)
    return np.maximum(np.abs(first), np.where(inside, np.abs(value), 0.0))
