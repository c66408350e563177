"""A path whose whole motion is planned before it begins, and again where the model changes."""

from dataclasses import replace

import numpy as np

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.choice import Choice
from uvms_planner.fitness import cost
from uvms_planner.joined_path import JoinedPath
from uvms_planner.on_path import FollowedStep, OnPath
from uvms_planner.segment import Knot, tool_positions
from uvms_planner.solver import StepSolver, posture_of
from uvms_planner.whole_path import PathPlan
from uvms_planner.whole_path.change import Change
from uvms_planner.whole_path.window import TimedPlan


class PlannedPath(OnPath):
    """Gives the steps of a plan over a whole path that begins at the stamp `start`.

    The samples are those of the plan itself, so that the tool is on the path between the knots as
    it is at them. Where payload or thrusters are not as they were when it was made, what is left is
    planned anew (`Change`).
    """

    def __init__(
        self, solver: StepSolver, path: JoinedPath, plan: PathPlan, start: int, step: float
    ) -> None:
        super().__init__(path, start)
        self.motion = TimedPlan(0.0, plan)
        self._solver, self._step = solver, step
        self._problem = plan.problem
        self._changed = False
        self._change: Change | None = None

    def reconsider(self) -> None:
        """Plan anew from the next step on: the model, or what the thrusters have, has changed."""
        self._changed = True

    def _replan(self, begin: float, knot: Knot) -> None:
        """Let the motion from `begin` s of the path on be what suits the model as it is now."""
        if self._changed:
            self._changed = False
            problem = replace(
                self._problem,
                model=self._solver.model,
                limits=self._solver.limits_from(knot.configuration),
                around=self._solver.around_from(knot.configuration),
            )
            self._change = Change(problem, begin, self.motion)
        if self._change is not None:
            self.motion = self._change.step(begin, posture_of(knot), self.motion)
            if self._change.over:
                self._change = None

    def plan(self, knot: Knot, times: Array) -> FollowedStep:
        """The step after `knot`, sampled at `times` (k,) s."""
        begin = to_seconds(knot.stamp - self._start)
        self._replan(begin, knot)
        samples = self.motion.sample(begin + times)
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
