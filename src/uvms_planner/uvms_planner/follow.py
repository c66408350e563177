"""Following an end-effector path, step by step."""

import numpy as np

from uvms_core.signals import Array, to_nanoseconds, to_seconds
from uvms_planner.joined_path import JoinedPath
from uvms_planner.knot_motion import knot_motion
from uvms_planner.on_path import FollowedStep, OnPath
from uvms_planner.segment import Knot, hermite, tool_positions
from uvms_planner.solver import StepSolver


class PathFollower(OnPath):
    """Plans the steps of one path that begins at the stamp `start`."""

    def __init__(self, solver: StepSolver, path: JoinedPath, start: int, step: float):
        super().__init__(path, start)
        self._solver, self._step = solver, step

    def plan(self, knot: Knot, times: Array) -> FollowedStep:
        """The step after `knot`, sampled at `times` (k,) s; where `choice.valid` is False the
        nearest that can be reached.
        """
        begin = to_seconds(knot.stamp - self._start)
        target = self.path.sample(begin + self._step)
        problem = self._solver.problem(knot.configuration, knot.increment, target)
        index = round(knot.stamp / to_nanoseconds(self._step))
        choice = self._solver.choose(problem, index)
        rate, acceleration = knot_motion(
            self._solver.model, problem, choice.increment, *self._tool_motion(begin + self._step)
        )
        end = Knot(
            stamp=knot.stamp + to_nanoseconds(self._step),
            configuration=knot.configuration + choice.increment,
            rate=rate,
            acceleration=acceleration,
            increment=choice.increment,
        )
        samples = hermite(knot, end, self._step, times)
        wanted = self.path.goal.positions(begin + times)
        gaps = tool_positions(self._solver.model, samples.configuration) - wanted
        return FollowedStep(end, samples, problem, choice, float(_longest(gaps)))

    def _tool_motion(self, time: float) -> tuple[Array, Array]:
        """Velocity and acceleration (6,) of the tool on the path, linear and angular.

        The acceleration is the mean over a step, because the path's own jumps at its points.
        """
        half = self._step / 2
        before, after = self._rate(time - half), self._rate(time + half)
        return self._rate(time), (after - before) / self._step

    def _rate(self, time: float) -> Array:
        sample = self.path.sample(time)
        rate = np.zeros(6)
        rate[:3] = sample.velocity
        if sample.angular_velocity is not None:
            rate[3:] = sample.angular_velocity
        return rate


def _longest(vectors: Array) -> float:
    return np.sqrt(np.max(np.sum(vectors**2, axis=1)))
