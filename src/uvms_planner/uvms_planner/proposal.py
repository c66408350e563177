"""A goal that is checked, and planned beside the steps before it begins."""

from collections.abc import Callable

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import JointGoal, PathGoal
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner.errors import GoalRejected
from uvms_planner.follow import PathFollower
from uvms_planner.goal_check import check_path_goal, check_reachable, check_start
from uvms_planner.joined_path import JoinedPath
from uvms_planner.joint_motion import JointTrajectory, check_joint_goal
from uvms_planner.on_path import OnPath
from uvms_planner.planned_path import PlannedPath
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.refusal import reason_of, refuse_axis, refuse_out_of_reach
from uvms_planner.segment import Knot
from uvms_planner.solver import StepSolver
from uvms_planner.whole_path import PathPlan, PathProblem, slow_down

Progress = Callable[[float, str], None]


def silent(share: float, text: str) -> None:
    """Nobody wants to hear of the progress."""


class Proposal:
    """What a goal asks for, from where the planned motion will be at rest.

    Raises GoalRejected where the goal is malformed or begins elsewhere.
    """

    def __init__(self, goal: PathGoal | JointGoal, knot: Knot, solver: StepSolver) -> None:
        self._goal, self._knot, self._solver = goal, knot, solver
        self._path: JoinedPath | None = None
        self.plan: PathPlan | None = None
        if isinstance(goal, JointGoal):
            check_joint_goal(goal, knot.configuration[VEHICLE:], solver.joints)
        else:
            self._path = self._joined(goal)

    def _joined(self, goal: PathGoal) -> JoinedPath:
        check_path_goal(goal)
        position, rotation = tool_pose(self._solver.model, self._knot.configuration)
        quaternion = matrix_to_quat(rotation)
        config = self._solver.config
        check_start(goal, position, quaternion, config)
        if len(goal.tool_axis) and not self._solver.plans_paths:
            refuse_axis(config.chosen)
        return JoinedPath(EndEffectorPath(goal), position, quaternion, config.approach_s)

    def work(self, progress: Progress) -> None:
        """Plan it, or see whether it can be followed step by step; seconds for a long path.

        Raises GoalRejected where it cannot be followed: when, and which limit stands against it.
        """
        if self._path is None:
            return
        if not self._solver.plans_paths:
            step = self._solver.config.step_s
            check_reachable(self._path, self._solver, self._knot.configuration, step)
            return
        problem = self._solver.path_problem(self._path, self._knot)
        self.plan = self._solver.plan_path(problem, progress)
        if not self.plan.report.feasible:
            self.plan = self._slower(problem, self.plan, progress)

    def _slower(self, problem: PathProblem, plan: PathPlan, progress: Progress) -> PathPlan:
        """The plan of the path as slowly as it must be, where the goal allows that."""
        refuse_out_of_reach(problem)
        slower = slow_down(problem, progress=progress)
        if slower is None:
            raise GoalRejected(f"path: it cannot be followed, however slowly; {reason_of(plan)}")
        if isinstance(self._goal, JointGoal):
            raise AssertionError("a motion of the joints is no path")
        allowed = self._goal.time_scale_max
        if slower.factor > allowed:
            raise GoalRejected(
                f"path too fast: {reason_of(plan)}; {slower.factor:.3g} times slower it can be"
                f" followed, and the goal's time_scale_max is {allowed:g}"
            )
        self._path = self._joined(self._goal.slowed(slower.factor))
        plan = self._solver.plan_path(self._solver.path_problem(self._path, self._knot), progress)
        if not plan.report.feasible:
            raise GoalRejected(f"path: {slower.factor:.3g} times slower; {plan.report.worst}")
        return plan

    def motion_from(self, knot: Knot) -> OnPath | JointTrajectory:
        """The motion from a knot at rest in the configuration that was planned from."""
        step = self._solver.config.step_s
        if isinstance(self._goal, JointGoal):
            return JointTrajectory(self._goal, knot.configuration, knot.stamp, step)
        if (knot.configuration != self._knot.configuration).any():
            raise GoalRejected("the vehicle was moved while the goal was being planned")
        if self._path is None:
            raise AssertionError("a path goal has a path")
        if self.plan is None:
            return PathFollower(self._solver, self._path, knot.stamp, step)
        return PlannedPath(self._solver, self._path, self.plan, knot.stamp, step)
