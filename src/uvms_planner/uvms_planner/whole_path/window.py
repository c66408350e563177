"""The next seconds of a path planned anew from where things are: the whole-path plan on a window.

A real-time iteration (Diehl, Bock and Schloeder 2005): from the last solution, shifted, one or two
Newton steps with a fixed barrier; the motion joins the whole path's plan at the window's end, so
that what was feasible stays so.
"""

from dataclasses import dataclass, replace

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_planner.limits import MotionLimits
from uvms_planner.whole_path.discrete import Discrete, discretise
from uvms_planner.whole_path.newton import Iteration
from uvms_planner.whole_path.path_problem import CostWeights, PathProblem, Posture, ToolPath
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.sample import NO_SURROUNDINGS, Surroundings
from uvms_planner.whole_path.spline import basis_at, greville, knots_at

PIECES_S = (0.25,) * 2 + (0.5,) * 5 + (1.0,) * 5 + (2.0,) * 4  # 16 s
SAMPLES = 2  # of each piece
TIGHT = 0.98  # of sampled limits: there are fewer samples than of a whole path
BARRIER = 1e-4
FIRST_STEPS = 6  # of a window that has none before it
PRICE = 1e3  # of a broken limit


@dataclass(frozen=True)
class WindowPlan:
    """The plan of one window: `plan` counts its times from `begin` s of the path."""

    begin: float
    plan: PathPlan
    gained: float  # by which the last step lowered the cost

    def posture(self, times: Array) -> Array:
        """Yaw and joints with two derivatives at `times` (k,) s of the path: (k, 3, d)."""
        return self.plan.posture(np.asarray(times, dtype=float) - self.begin)

    @property
    def end(self) -> float:
        """Time of the path at which the window ends, s."""
        return self.begin + self.plan.duration


class PathWindow:
    """Plans windows of one path, one after the other.

    Without a plan of the whole path the motion comes to rest at the window's end.
    """

    def __init__(
        self,
        model: Model,
        tool: ToolPath,
        limits: MotionLimits,
        whole: PathPlan | None = None,
        weights: CostWeights | None = None,
        around: Surroundings = NO_SURROUNDINGS,
    ):
        self.model = model  # may be exchanged when the payload changes
        self.tool = tool
        self.limits = limits
        self.whole = whole
        self.around = around
        self._weights = weights or CostWeights()
        self._breaks = np.concatenate([[0.0], np.cumsum(PIECES_S)])
        self._knots = knots_at(self._breaks)
        self._sites = greville(self._knots)
        basis = basis_at(self._knots, self._sites)
        fit = np.zeros((len(self._sites), len(self._sites)))
        for row, first, values in zip(fit, basis.first, basis.values[:, 0], strict=True):
            row[first : first + len(values)] = values
        self._fit = np.linalg.inv(fit)
        self._template: Discrete | None = None

    @property
    def duration(self) -> float:
        """Length of a window in s."""
        return float(self._breaks[-1])

    def solve(
        self, begin: float, start: Posture, last: WindowPlan | None = None, steps: int | None = None
    ) -> WindowPlan:
        """The motion from `begin` s of the path on, which starts as `start`.

        `last` is the window before; from it, or the whole path's plan, or a posture held, the
        search begins; one step then, more for the first window. Nothing here is random.
        """
        discrete = self._discrete(begin, start)
        point = Iteration(discrete, self._guess(begin, start, last), PRICE)
        gained = 0.0
        steps = steps or (FIRST_STEPS if last is None else 1)
        for _ in range(steps):
            gained = point.step(BARRIER)[0]
        plan = PathPlan(discrete.problem, self._knots, point.coefficients, steps)
        return WindowPlan(begin, plan, gained)

    def _discrete(self, begin: float, start: Posture) -> Discrete:
        problem = PathProblem(
            self.model, self.tool.after(begin), self.duration, start, self.limits, self._weights,
            self.around, self._end(begin),
        )  # fmt: skip
        template = self._template
        if template is None or (template.problem.end is None) != (problem.end is None):
            template = discretise(problem, self._breaks, SAMPLES, TIGHT)
            self._template = template
        return replace(
            template, problem=problem, target=problem.target(template.times), around=self.around
        )

    def _end(self, begin: float) -> Posture | None:
        if self.whole is None:
            return None
        return Posture(*self.whole.posture(np.array([begin + self.duration]))[0])

    def _guess(self, begin: float, start: Posture, last: WindowPlan | None) -> Array:
        times = begin + self._sites
        if last is None:
            if self.whole is None:
                return np.tile(start.value, (len(times), 1))
            return self._fit @ self.whole.posture(times)[:, 0]
        values = last.posture(times)[:, 0]
        later = times > last.end
        if self.whole is not None and later.any():
            values[later] = self.whole.posture(times[later])[:, 0]
        return self._fit @ values
