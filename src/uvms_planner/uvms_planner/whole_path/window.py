"""The next seconds of a path planned anew from where things are: the whole-path plan on a window.

A real-time iteration (Diehl, Bock and Schloeder 2005): from the last solution, shifted, a Newton
step with a fixed barrier. The motion joins a plan of the whole path at the window's end, so that
whoever follows a window to its end has a motion that goes on; without one it comes to rest there.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import make_interp_spline

from uvms_core.signals import Array
from uvms_planner.problem import VEHICLE
from uvms_planner.segment import Samples
from uvms_planner.whole_path.assembly import Bounds
from uvms_planner.whole_path.discrete import Discrete, discretise
from uvms_planner.whole_path.newton import Iteration
from uvms_planner.whole_path.path_problem import PathProblem, Posture
from uvms_planner.whole_path.plan import PathPlan, plan_values
from uvms_planner.whole_path.plan_report import FORGIVEN, PlanReport, report_of
from uvms_planner.whole_path.sample import MANIPULABILITY, TURN, WRENCHES
from uvms_planner.whole_path.sampled_bounds import sampled_bounds
from uvms_planner.whole_path.solve import HIGHER, SPARE, posture_held, size_of
from uvms_planner.whole_path.spline import DEGREE, Basis, basis_at, greville, spline_values

PIECES_S = (0.25,) * 2 + (0.5,) * 5 + (1.0,) * 5 + (2.0,) * 3 + (1.5, 0.5)  # 16 s
SHORTEST_S = 2.0  # of a window that is cut off by the path's end
SAMPLES = 2  # of each piece
TIGHT = 0.98  # of sampled limits: there are fewer samples than of a whole path
BARRIER = 1e-4
FIRST_BARRIERS = (1e-2,) * 3 + (1e-3,) * 3 + (1e-4,) * 4  # of a window that has none before it
PRICE = 1e3  # of a broken limit
REPAIR_STEPS = 4  # at most with tighter limits, where a window exceeds them between samples
ENDS_TOGETHER_S = 1e-9  # ends of a window and of a step are the same, but for rounding


@dataclass(frozen=True)
class TimedPlan:
    """A plan from `begin` s of the path on, and the one that follows it at its end."""

    begin: float
    plan: PathPlan
    then: "TimedPlan | None" = None  # None: it rests
    feasible: bool = False  # whether it is known to keep every limit

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

    def __init__(self, problem: PathProblem):
        """`problem` is that of the whole path."""
        self._problem = problem
        self._breaks = np.concatenate([[0.0], np.cumsum(PIECES_S)])
        self._templates: dict[tuple[float, bool], _Template] = {}
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
        template = self._template(begin, start, then, length)
        discrete = template.discrete
        if self._size is None:
            self._size = size_of(discrete, posture_held(discrete))
        known, guess = last or known, posture_held(discrete)
        if known is not None:
            guess = template.fit @ _led_over(known, then, begin, length, template.sites)
        barriers = FIRST_BARRIERS if last is None else (BARRIER,)
        plan = self._iterated(discrete, guess, barriers)
        kept, excess = template.examined(plan)
        if not kept:
            plan, kept = self._repaired(template, plan, excess)
        return TimedPlan(begin, plan, then, kept)

    def _repaired(
        self, template: "_Template", plan: PathPlan, excess: Array
    ) -> tuple[PathPlan, bool]:
        """A window with its limits tightened by what it exceeds them, and whether it keeps them."""
        tight = template.discrete.tightened(excess + SPARE)
        size, kept = self._size or 1.0, False
        point = Iteration(tight, plan.coefficients, size * HIGHER * PRICE)
        for _ in range(REPAIR_STEPS):
            point.step(size * BARRIER)
            plan = PathPlan(tight.problem, tight.knots, point.coefficients, 1)
            kept, _ = template.examined(plan)
            if kept:
                break
        return plan, kept

    def _iterated(self, discrete: Discrete, start: Array, barriers: tuple[float, ...]) -> PathPlan:
        size = self._size or 1.0
        point = Iteration(discrete, start, size * PRICE)
        for barrier in barriers:
            point.step(size * barrier)
        return PathPlan(discrete.problem, discrete.knots, point.coefficients, len(barriers))

    def _template(
        self, begin: float, start: Posture, then: TimedPlan | None, length: float
    ) -> "_Template":
        """The window on its knots, with what is the same for all windows of its length."""
        end = None if then is None else then.state(begin + length)
        tool = self._problem.tool.after(begin)
        problem = replace(self._problem, tool=tool, duration=length, start=start, end=end)
        key = length, end is None
        if key not in self._templates:
            breaks = self._breaks * (length / self.duration)
            self._templates = {key: _Template.of(discretise(problem, breaks, SAMPLES, TIGHT))}
        template = self._templates[key]
        own = template.discrete
        target = problem.target(own.times)
        return replace(template, discrete=replace(own, problem=problem, target=target))


@dataclass(frozen=True)
class _Template:
    """A window on its knots, and what else is worked out once for all windows of its length."""

    discrete: Discrete
    bounds: Bounds  # of sampled values, as they are
    sites: Array  # (K,) s
    fit: Array  # (K, K) from values at the sites to coefficients
    instants: Array  # (k,) s, at which a window is examined
    basis: Basis  # there

    @staticmethod
    def of(discrete: Discrete) -> "_Template":
        sites = greville(discrete.knots)
        instants = PathPlan(discrete.problem, discrete.knots, np.zeros((0, 0)), 0).instants()
        fit = make_interp_spline(sites, np.eye(len(sites)), k=DEGREE, t=discrete.knots).c
        basis = basis_at(discrete.knots, instants)
        return _Template(discrete, sampled_bounds(discrete.problem), sites, fit, instants, basis)

    def examined(self, plan: PathPlan) -> tuple[bool, Array]:
        """Whether a window certainly keeps all limits (where not, its report knows more), and the
        shares (v,) by which the sampled values exceed theirs, or negative.
        """
        problem, bounds = self.discrete.problem, self.bounds
        posture = spline_values(self.basis, plan.coefficients)
        target = problem.target(self.instants)
        values = plan_values(problem.model, problem.around, posture, target)
        sampled = values[:, WRENCHES:]
        beyond = np.maximum(sampled - bounds.upper, bounds.lower - sampled).max(axis=0)
        excess = beyond / bounds.scale
        over = max(float(excess.max()), _posture_excess(problem, posture))
        if problem.tool.oriented:
            turn = np.linalg.norm(values[:, TURN:MANIPULABILITY], axis=1).max()
            over = max(over, float(turn) / problem.turn_tolerance - 1)
        return over <= FORGIVEN, excess


def _posture_excess(problem: PathProblem, posture: Array) -> float:
    """The greatest share by which yaw and joints, rates and accelerations exceed their limits."""
    limits, c, start = problem.limits, slice(VEHICLE - 1, None), problem.start.value
    low, high = np.minimum(limits.lower[c], start), np.maximum(limits.upper[c], start)
    return max(
        float(np.max(posture[:, 0] - high)),
        float(np.max(low - posture[:, 0])),
        float(np.max(np.abs(posture[:, 1]) / limits.rate[c])) - 1,
        float(np.max(np.abs(posture[:, 2]) / limits.acceleration[c])) - 1,
    )


def _led_over(
    known: TimedPlan, then: TimedPlan | None, begin: float, length: float, times: Array
) -> Array:
    """Yaw and joints (k, d) that go over evenly from one motion to another."""
    values = known.posture(begin + times)[:, 0]
    if then is None or then is known.then:
        return values
    u = (times / length)[:, None]
    share = u**3 * (10 - 15 * u + 6 * u**2)
    return values + share * (then.posture(begin + times)[:, 0] - values)


def acceptable(new: TimedPlan, in_hand: TimedPlan, since: float) -> bool:
    """Whether a plan keeps all limits from `since` s on, or none worse than the motion in hand.

    After a thruster has failed, say, there may be no plan that keeps all of them.
    """
    if new.feasible:
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
