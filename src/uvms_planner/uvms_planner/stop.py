"""Coming to rest and staying there: before a goal, after its end, and when it is cancelled."""

import math

import numpy as np

from uvms_dynamics.signals import to_nanoseconds
from uvms_planner.knot_motion import meet
from uvms_planner.limits import PEAK_BRAKING
from uvms_planner.path import PathSample
from uvms_planner.projection import project
from uvms_planner.segment import Knot, Samples, evaluate, hermite, quintic
from uvms_planner.solver import StepSolver


class Stop:
    """Brakes from a moving knot and holds; with an `anchor` the end effector stays at it."""

    def __init__(
        self, solver: StepSolver, start: Knot, step: float, anchor: PathSample | None = None
    ):
        self._solver, self._start, self._step, self._anchor = solver, start, step, anchor
        self._steps = _steps_to_rest(start, solver, step)
        duration = max(self._steps, 1) * step
        # the end that makes the rate fall as (1 - u)^2 (1 + 2 u), u = t / duration
        end = (
            start.configuration + start.rate * duration / 2 + start.acceleration * duration**2 / 12
        )
        zero = np.zeros_like(end)
        self._coefficients = quintic(
            (start.configuration, start.rate, start.acceleration), (end, zero, zero), duration
        )

    @property
    def rest(self) -> int:
        """Stamp from which on nothing moves."""
        return self._start.stamp + self._steps * to_nanoseconds(self._step)

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
        elapsed = (stamp - self._start.stamp) / to_nanoseconds(1.0)
        state = evaluate(self._coefficients, np.array([elapsed]))
        increment = state.configuration[0] - knot.configuration
        if self._anchor is None:
            return Knot(
                stamp, state.configuration[0], state.rate[0], state.acceleration[0], increment
            )
        problem = self._solver.problem(
            knot.configuration,
            knot.increment,
            self._anchor,
            self._solver.limits.rate_increments(knot.configuration),
        )
        project(self._solver.model, problem, increment)
        end, still = knot.configuration + increment, np.zeros(6)
        rate, acceleration = state.rate[0].copy(), state.acceleration[0].copy()
        if stamp < self.rest:
            meet(self._solver.model, problem, end, still, still, rate, acceleration)
        return Knot(stamp, end, rate, acceleration, increment)


def _steps_to_rest(start: Knot, solver: StepSolver, step: float) -> int:
    if not (np.any(start.rate) or np.any(start.acceleration)):
        return 0
    deceleration = solver.limits.jump / step**2
    seconds = float(np.max(PEAK_BRAKING * np.abs(start.rate) / deceleration))
    return max(1, math.ceil(seconds / step))
