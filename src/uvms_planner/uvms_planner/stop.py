"""Coming to rest and staying there: before a goal, after its end, and when it is cancelled."""

import numpy as np
from numpy.typing import NDArray

from uvms_core.end_effector_path import PathSample
from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.knot_motion import meet
from uvms_planner.limits import PEAK_BRAKING
from uvms_planner.projection import project
from uvms_planner.segment import Knot, Samples, evaluate, hermite, quintic
from uvms_planner.solver import StepSolver


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
    """Whole steps (m,) in which each variable can come to rest; 0 for those at rest."""
    deceleration = solver.limits.jump / step**2
    seconds = PEAK_BRAKING * np.abs(start.rate) / deceleration
    moving = (start.rate != 0.0) | (start.acceleration != 0.0)
    return np.where(moving, np.maximum(1, np.ceil(seconds / step)), 0).astype(np.int64)
