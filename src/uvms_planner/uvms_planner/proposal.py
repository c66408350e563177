"""A goal that is checked, and planned beside the steps before it begins."""

from collections.abc import Callable

import numpy as np

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import Array, Goal, JointGoal, PathGoal, PoseGoal
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner.errors import GoalRejected
from uvms_planner.follow import PathFollower
from uvms_planner.goal_check import check_path_goal, check_reachable, check_start
from uvms_planner.joined_path import JoinedPath
from uvms_planner.joint_motion import JointTrajectory, check_joint_goal
from uvms_planner.on_path import OnPath
from uvms_planner.planned_path import PlannedPath
from uvms_planner.pose_motion import allowed_between, check_pose_goal, plan_pose, plan_straight
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.refusal import reason_of, refuse_axis, refuse_out_of_reach
from uvms_planner.segment import Knot
from uvms_planner.solver import StepSolver
from uvms_planner.straight_motion import Profile, StraightMotion
from uvms_planner.timed_motion import TimedMotion
from uvms_planner.whole_path import PathPlan, PathProblem, slow_down

Progress = Callable[[float, str], None]
Motion = OnPath | TimedMotion
"""What the planner follows for a goal."""


def silent(share: float, text: str) -> None:
    """Nobody wants to hear of the progress."""


class Proposal:
    """What a goal asks for, from where the planned motion will be at rest.

    `present` is where the motion is now, where it still moves: a path may begin near that, too.

    Raises GoalRejected where the goal is malformed or begins elsewhere.
    """

    def __init__(
        self, goal: Goal, knot: Knot, solver: StepSolver, present: Knot | None = None
    ) -> None:
        self._goal, self._knot, self._solver, self._present = goal, knot, solver, present
        self._path: JoinedPath | None = None
        self._pose: StraightMotion | None = None
        self.plan: PathPlan | None = None
        if isinstance(goal, JointGoal):
            check_joint_goal(goal, knot.configuration[VEHICLE:], solver.joints)
        elif isinstance(goal, PoseGoal):
            self._pose_end = check_pose_goal(goal, knot.configuration, solver)
        else:
            self._path = self._joined(goal)

    def is_of(self, solver: StepSolver) -> bool:
        """Whether it was planned with this solver."""
        return self._solver is solver

    def distance(self, knot: Knot) -> float:
        """How far the vehicle is at a knot from where the motion was planned from, m."""
        return float(np.linalg.norm(knot.configuration[:3] - self._knot.configuration[:3]))

    def _joined(self, goal: PathGoal) -> JoinedPath:
        check_path_goal(goal)
        position, quaternion = self._tool(self._knot)
        config = self._solver.config
        try:
            check_start(goal, position, quaternion, config)
        except GoalRejected:
            if self._present is None:
                raise
            check_start(goal, *self._tool(self._present), config)
        if len(goal.tool_axis) and not self._solver.plans_paths:
            refuse_axis(config.chosen)
        return JoinedPath(EndEffectorPath(goal), position, quaternion, config.approach_s)

    def _tool(self, knot: Knot) -> tuple[Array, Array]:
        """Position (3,) and quaternion (4,) of the tool at a knot."""
        position, rotation = tool_pose(self._solver.model, knot.configuration)
        return position, matrix_to_quat(rotation)

    def work(self, progress: Progress) -> None:
        """Plan it, or see whether it can be followed step by step; seconds for a long path.

        Raises GoalRejected where it cannot be followed: when, and which limit stands against it.
        """
        if isinstance(self._goal, PoseGoal):
            ends = self._knot.configuration, self._pose_end
            self._pose = plan_pose(self._goal, ends, self._solver)
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
        if not slower.plan.report.feasible:
            raise GoalRejected(
                f"path: it cannot be followed, however slowly; in {slower.factor:.3g} times the"
                f" time, {reason_of(slower.plan)}"
            )
        if not isinstance(self._goal, PathGoal):
            raise AssertionError("only a path is planned so")
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

    def motion_from(self, knot: Knot) -> tuple[StraightMotion | None, Motion]:
        """The goal's motion from a knot at rest, and the way from there to where it begins, if any.

        Where the knot is not the one that was planned from, what is quickly planned is planned
        again; to where a whole path was planned from the vehicle goes first. Raises GoalRejected
        where that cannot be.
        """
        step = self._solver.config.step_s
        moved = bool((knot.configuration != self._knot.configuration).any())
        if moved and self.plan is None:
            again = Proposal(self._goal, knot, self._solver, self._present)
            again.work(silent)
            return again.motion_from(knot)
        if isinstance(self._goal, JointGoal):
            return None, JointTrajectory(self._goal, knot.configuration, knot.stamp, step)
        if self._pose is not None:
            return None, self._pose.starting(knot.stamp)
        if self._path is None:
            raise AssertionError("it has not been worked on")
        if self.plan is None:
            return None, PathFollower(self._solver, self._path, knot.stamp, step)
        way = self._way_from(knot) if moved else None
        start = knot.stamp if way is None else way.end
        return way, PlannedPath(self._solver, self._path, self.plan, start, step)

    def _way_from(self, knot: Knot) -> StraightMotion | None:
        """Whole steps from a knot at rest straight to where the path was planned from."""
        ends = knot.configuration, self._knot.configuration
        allowed = allowed_between(ends, self._solver)
        if not np.isfinite(allowed[0]):
            return None
        profile = Profile.fastest(*allowed)
        try:
            way = plan_straight(ends, profile, self._solver)
        except GoalRejected as fault:
            raise GoalRejected(
                f"the vehicle went on while the path was being planned, and back: {fault}"
            ) from fault
        step = self._solver.config.step_s
        whole = step * float(np.ceil(way.duration / step))
        in_steps = (way.profile or profile).slower(whole / way.duration)
        return way.along(in_steps).starting(knot.stamp)
