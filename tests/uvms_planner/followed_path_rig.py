"""A planned path followed step by step, with what changes on the way."""

from dataclasses import dataclass

import numpy as np
from planner_rig import reference_vehicle
from whole_path_rig import CIRCLE, LINE, bluerov2, start_of

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import DisturbanceBudget, Payload, ThrusterHealth
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner import PathSpec, PlannerConfig
from uvms_planner.joined_path import JoinedPath
from uvms_planner.planned_path import PlannedPath
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.segment import Knot, Samples
from uvms_planner.solver import StepSolver, posture_of
from uvms_planner.whole_path import PathPlan, PathProblem, PlanReport, ToolPath
from uvms_planner.whole_path.plan import plan_values
from uvms_planner.whole_path.plan_report import report_of

STEP_S = 0.5
MS = 500  # samples of a step
PATHS = {"circle": CIRCLE, "line": LINE}
VEHICLES = {"reference": reference_vehicle, "bluerov2": bluerov2}


def payload(newton: float) -> DisturbanceBudget:
    """A weight in the gripper."""
    zero = np.zeros(6)
    held = Payload(True, 0.15 * newton, 0.01, newton, 0.1, np.zeros(3), np.full(3, 0.01))
    return DisturbanceBudget(0, zero, zero, zero, zero, held)


def dead(number: int, thrusters: int) -> DisturbanceBudget:
    """A thruster that gives nothing any more."""
    left = np.ones(thrusters)
    left[number] = 0.0
    return weak(left)


def weak(left: np.ndarray) -> DisturbanceBudget:
    """Thrusters that give a share of what they are told."""
    zero, health = np.zeros(6), ThrusterHealth(left, np.full(len(left), 0.01))
    return DisturbanceBudget(0, zero, zero, zero, zero, None, health)


def begun(vehicle: str, path: str) -> tuple[StepSolver, JoinedPath, Knot, PathPlan]:
    """A solver that knows of no change, the path, where it begins and its plan."""
    solver = StepSolver(VEHICLES[vehicle](), PlannerConfig(), 1)
    knot = Knot.at_rest(0, start_of(VEHICLES[vehicle]()))
    position, rotation = tool_pose(solver.model, knot.configuration)
    tool = matrix_to_quat(rotation)
    goal = PathSpec.model_validate(PATHS[path]).goal(position, tool)
    joined = JoinedPath(EndEffectorPath(goal), position, tool, 5.0)
    return solver, joined, knot, _planned(vehicle, path, solver, joined, knot)


_PLANS: dict[tuple[str, str], PathPlan] = {}


def _planned(vehicle, path, solver, joined, knot) -> PathPlan:
    if (vehicle, path) not in _PLANS:
        problem = solver.path_problem(joined, knot)
        _PLANS[vehicle, path] = solver.plan_path(problem, lambda share, text: None)
    return _PLANS[vehicle, path]


@dataclass(frozen=True)
class Followed:
    """The samples of all steps at 1 kHz, and the problem of what is left at the last change."""

    steps: list[Samples]
    rest: PathProblem
    changed: float  # s
    motion: PlannedPath

    def joined(self, name: str) -> np.ndarray:
        """One after the other, the doubled ends left out."""
        parts = [getattr(step, name)[:-1] for step in self.steps]
        return np.concatenate([*parts, getattr(self.steps[-1], name)[-1:]])

    def since_the_change(self, after: float = 0.0) -> PlanReport:
        """What is planned from `after` s later on costs, and takes of every limit, at 1 kHz."""
        first = round(1e3 * (self.changed + after))
        names = ("configuration", "rate", "acceleration")
        posture = np.stack([self.joined(name)[first:, VEHICLE - 1 :] for name in names], axis=1)
        times = after + 1e-3 * np.arange(len(posture))
        target = self.rest.target(times)
        values = plan_values(self.rest.model, self.rest.around, posture, target)
        return report_of(self.rest, times, posture, values)


def follow(vehicle: str, path: str, changes: dict[float, DisturbanceBudget]) -> Followed:
    """The whole path, with `changes` by the time in s at which they become known."""
    solver, joined, knot, plan = begun(vehicle, path)
    motion, steps, rest = PlannedPath(solver, joined, plan, 0, STEP_S), [], plan.problem
    times = np.linspace(0.0, STEP_S, MS + 1)
    for index in range(round(joined.duration / STEP_S)):
        begin = index * STEP_S
        if begin in changes:
            assert solver.take(changes[begin])
            motion.reconsider()
            rest = _rest(solver, joined, knot, begin)
        step = motion.plan(knot, times)
        steps.append(step.samples)
        knot = step.knot
    return Followed(steps, rest, max(changes), motion)


def _rest(solver: StepSolver, joined: JoinedPath, knot: Knot, begin: float) -> PathProblem:
    return PathProblem(
        solver.model, ToolPath(joined).after(begin), joined.duration - begin, posture_of(knot),
        solver.limits_from(knot.configuration), around=solver.around_from(knot.configuration),
    )  # fmt: skip
