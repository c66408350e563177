"""A path whose whole motion is planned before it begins, and again where the model changes."""

import numpy as np

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.choice import Choice
from uvms_planner.fitness import cost
from uvms_planner.joined_path import JoinedPath
from uvms_planner.on_path import FollowedStep, OnPath
from uvms_planner.segment import Knot, Samples, tool_positions
from uvms_planner.solver import StepSolver, posture_of
from uvms_planner.whole_path import PathPlan
from uvms_planner.whole_path.window import PathWindow, WindowPlan


class PlannedPath(OnPath):
    """Gives the steps of a plan over a whole path that begins at the stamp `start`.

    The samples are those of the plan itself, so that the tool is on the path between the knots as
    it is at them. Where payload or thrusters are not as they were when it was made, every step
    plans the next seconds anew (`PathWindow`).
    """

    def __init__(
        self, solver: StepSolver, path: JoinedPath, plan: PathPlan, start: int, step: float
    ) -> None:
        super().__init__(path, start)
        self.motion = plan
        self._solver, self._step = solver, step
        self._window: PathWindow | None = None
        self._last: WindowPlan | None = None

    def reconsider(self) -> None:
        """Plan anew from the next step on: the model, or what the thrusters have, has changed."""
        problem = self.motion.problem
        configuration = self.motion.sample(np.zeros(1)).configuration[0]
        self._last = None
        self._window = PathWindow(
            self._solver.model,
            problem.tool,
            self._solver.limits_from(configuration),
            self.motion,
            problem.weights,
            self._solver.around,
        )

    def _samples(self, knot: Knot, times: Array) -> Samples:
        """The motion at `times` (k,) s of the path, from the knot on."""
        begin = float(times[0])
        if self._window is not None and begin + self._window.duration <= self.path.duration:
            self._last = self._window.solve(begin, posture_of(knot), self._last)
        if self._last is not None and times[-1] <= self._last.end:
            return self._last.plan.sample(times - self._last.begin)
        return self.motion.sample(times)

    def plan(self, knot: Knot, times: Array) -> FollowedStep:
        """The step after `knot`, sampled at `times` (k,) s."""
        begin = to_seconds(knot.stamp - self._start)
        samples = self._samples(knot, begin + times)
        wanted = self.path.goal.positions(begin + times)
        tool = tool_positions(self._solver.model, samples.configuration)
        gaps = np.linalg.norm(tool - wanted, axis=1)
        end = Knot(
            stamp=knot.stamp + to_nanoseconds(self._step),
            configuration=samples.configuration[-1],
            rate=samples.rate[-1],
            acceleration=samples.acceleration[-1],
            increment=samples.configuration[-1] - knot.configuration,
        )
        target = self.path.sample(begin + self._step)
        problem = self._solver.problem(knot.configuration, knot.increment, target)
        spent = cost(self._solver.model, problem, end.increment)
        violation = self._solver.attitude_violation(end.configuration)
        choice = Choice(True, end.increment, float(gaps[-1]), 0.0, violation, spent, 0, 0, 0)
        return FollowedStep(end, samples, problem, choice, float(gaps.max()))
