"""The next seconds of a path planned anew from where things are: the whole-path plan on a window.

A real-time iteration (Diehl, Bock and Schloeder 2005): from the last solution, shifted, a Newton
step with a fixed barrier. The motion joins a plan of the whole path at the window's end, so that
whoever follows a window to its end has a motion that goes on; without one it comes to rest there.
"""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_planner.limits import MotionLimits
from uvms_planner.segment import Samples
from uvms_planner.whole_path.discrete import Discrete, discretise
from uvms_planner.whole_path.newton import Iteration
from uvms_planner.whole_path.path_problem import CostWeights, PathProblem, Posture, ToolPath
from uvms_planner.whole_path.plan import PathPlan, plan_values
from uvms_planner.whole_path.plan_report import FORGIVEN, PlanReport, report_of
from uvms_planner.whole_path.replan import fitted
from uvms_planner.whole_path.sample import NO_SURROUNDINGS, Surroundings
from uvms_planner.whole_path.solve import HIGHER, SPARE, posture_held, size_of

PIECES_S = (0.25,) * 2 + (0.5,) * 5 + (1.0,) * 5 + (2.0,) * 4  # 16 s
SHORTEST_S = 2.0  # of a window that is cut off by the path's end
SAMPLES = 2  # of each piece
TIGHT = 0.98  # of sampled limits: there are fewer samples than of a whole path
BARRIER = 1e-4
FIRST_BARRIERS = (1e-2,) * 3 + (1e-3,) * 3 + (1e-4,) * 4  # of a window that has none before it
PRICE = 1e3  # of a broken limit
REPAIRS = 2  # times that limits are tightened where the window exceeds them between samples
REPAIR_STEPS = 3
ENDS_TOGETHER_S = 1e-9  # ends of a window and of a step are the same, but for rounding


@dataclass(frozen=True)
class TimedPlan:
    """A plan from `begin` s of the path on, and the one that follows it at its end."""

    begin: float
    plan: PathPlan
    then: "TimedPlan | None" = None  # None: it rests

    @property
    def end(self) -> float:
        """Time of the path at which this plan ends, s."""
        return self.begin + self.plan.duration

    def posture(self, times: Array) -> Array:
        """Yaw and joints with two derivatives at `times` (k,) s of the path: (k, 3, d)."""
        times = np.asarray(times, dtype=float)
        found = self.plan.posture(times - self.begin)
        later = times > self.end
        if self.then is not None and later.any():
            found[later] = self.then.posture(times[later])
        return found

    def sample(self, times: Array) -> Samples:
        """The configuration with two derivatives at `times` (k,) s, increasing, all of one plan."""
        if self.then is not None and times[-1] > self.end + ENDS_TOGETHER_S:
            return self.then.sample(times)
        return self.plan.sample(times - self.begin)

    def state(self, time: float) -> Posture:
        """The posture at `time` s of the path."""
        return Posture(*self.posture(np.array([time]))[0])


class PathWindow:
    """Plans windows of one path, one after the other.

    Without a plan of the whole path the motion comes to rest at the window's end.
    """

    def __init__(
        self,
        model: Model,
        tool: ToolPath,
        limits: MotionLimits,
        weights: CostWeights | None = None,
        around: Surroundings = NO_SURROUNDINGS,
    ):
        self._model, self._tool, self._limits, self._around = model, tool, limits, around
        self._weights = weights or CostWeights()
        self._breaks = np.concatenate([[0.0], np.cumsum(PIECES_S)])
        self._templates: dict[tuple[float, bool], Discrete] = {}
        self._size: float | None = None

    @property
    def duration(self) -> float:
        """Length of a window in s."""
        return float(self._breaks[-1])

    def solve(
        self,
        begin: float,
        start: Posture,
        last: TimedPlan | None = None,
        then: TimedPlan | None = None,
        known: TimedPlan | None = None,
        duration: float | None = None,
    ) -> TimedPlan:
        """The motion from `begin` s of the path on, which starts as `start` and ends at `then`.

        The search begins at the window before, `last`, with a single step; without one it takes
        some more, from the motion `known`, or from the posture held. Nothing here is random.
        """
        length = self.duration if duration is None else duration
        discrete = self._discrete(begin, start, then, length)
        if self._size is None:
            self._size = size_of(discrete, posture_held(discrete))
        known, guess = last or known, posture_held(discrete)
        if known is not None:
            guess = fitted(discrete, partial(_led_over, known, then, begin, length))
        barriers = FIRST_BARRIERS if last is None else (BARRIER,)
        plan, price = self._iterated(discrete, guess, barriers, PRICE), PRICE
        for _ in range(REPAIRS):
            if plan.report.feasible:
                break
            discrete, price = discrete.tightened(plan.report.excess + SPARE), HIGHER * price
            plan = self._iterated(discrete, plan.coefficients, (BARRIER,) * REPAIR_STEPS, price)
        return TimedPlan(begin, plan, then)

    def _iterated(
        self, discrete: Discrete, start: Array, barriers: tuple[float, ...], price: float
    ) -> PathPlan:
        size = self._size or 1.0
        point = Iteration(discrete, start, size * price)
        for barrier in barriers:
            point.step(size * barrier)
        return PathPlan(discrete.problem, discrete.knots, point.coefficients, len(barriers))

    def _discrete(
        self, begin: float, start: Posture, then: TimedPlan | None, length: float
    ) -> Discrete:
        end = None if then is None else then.state(begin + length)
        problem = PathProblem(
            self._model, self._tool.after(begin), length, start, self._limits, self._weights,
            self._around, end,
        )  # fmt: skip
        key = length, end is None
        if key not in self._templates:
            breaks = self._breaks * (length / self.duration)
            self._templates = {key: discretise(problem, breaks, SAMPLES, TIGHT)}
        template = self._templates[key]
        return replace(template, problem=problem, target=problem.target(template.times))


def _led_over(
    known: TimedPlan, then: TimedPlan | None, begin: float, length: float, times: Array
) -> Array:
    """Yaw and joints (k, 3, d) that go over evenly from one motion to another, values alone."""
    values = known.posture(begin + times)
    if then is None or then is known.then:
        return values
    u = (times / length)[:, None, None]
    share = u**3 * (10 - 15 * u + 6 * u**2)
    return values + share * (then.posture(begin + times) - values)


def acceptable(new: TimedPlan, in_hand: TimedPlan, since: float) -> bool:
    """Whether a plan keeps all limits from `since` s on, or none worse than the motion in hand.

    After a thruster has failed, say, there may be no plan that keeps all of them.
    """
    if new.plan.report.feasible:
        return True
    times = new.plan.instants()
    times = times[new.begin + times >= since]
    before = {each.name: each.share for each in _report_of(in_hand, new, times).limits}
    return all(
        each.share <= max(1.0, before.get(each.name, 1.0)) + FORGIVEN
        for each in new.plan.report_at(times).limits
    )


def _report_of(in_hand: TimedPlan, new: TimedPlan, times: Array) -> PlanReport:
    """The report of the motion in hand, with the problem of a new plan, at that plan's `times`."""
    problem = new.plan.problem
    posture = np.ascontiguousarray(in_hand.posture(new.begin + times))
    values = plan_values(problem.model, problem.around, posture, problem.target(times))
    return report_of(problem, times, posture, values)
