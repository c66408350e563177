"""The motion planner: one call each step gives the motion of vehicle and joints one step ahead."""

import numpy as np

from uvms_dynamics import Vehicle, end_effector
from uvms_dynamics.errors import SignalError
from uvms_dynamics.rotations import matrix_to_quat
from uvms_dynamics.signals import (
    Array,
    JointGoal,
    JointStates,
    Odometry,
    PathGoal,
    Reference,
    to_nanoseconds,
    to_seconds,
)
from uvms_planner.config import PlannerConfig
from uvms_planner.errors import GoalRejected
from uvms_planner.follow import PathFollower
from uvms_planner.goal_check import check_path_goal, check_reachable, check_start
from uvms_planner.joint_motion import JointMotion, check_joint_goal
from uvms_planner.path import EndEffectorPath, JoinedPath
from uvms_planner.problem import VEHICLE
from uvms_planner.projection import tool_pose
from uvms_planner.report import GoalFeedback, GoalResult, PlannerStep, StepDiagnostics
from uvms_planner.segment import Knot, Samples, reference
from uvms_planner.solver import StepSolver
from uvms_planner.stop import Stop


class MotionPlanner:
    """Plans vehicle pose (x, y, z, psi) and joints so that the end effector follows a goal.

    At the tick t the segment [t + step, t + 2 step] is planned, so that planning never keeps the
    loop waiting; the first tick t_0 gives the segment [t_0, t_0 + step] besides, at rest. Without
    a goal the vehicle holds the pose of the first tick, level, and the joints theirs.
    """

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int):
        self._config = config
        self._solver = StepSolver(vehicle, config, seed)
        self._step = to_nanoseconds(config.step_s)
        self._times = _sample_times(config)
        self._tick: int | None = None
        self._knot: Knot | None = None
        self._stop: Stop | None = None
        self._goal: PathFollower | JointMotion | None = None
        self._finished: GoalResult | None = None
        self._planned_error = 0.0
        self._max_planned_error = 0.0
        self._diagnostics: StepDiagnostics | None = None

    def accept(self, goal: PathGoal | JointGoal) -> None:
        """Begin a goal with the first segment that is not planned yet.

        Raises GoalRejected where the goal is malformed, cannot be followed, or comes too early (no
        odometry yet) or too late (another goal is active).
        """
        if self._stop is None:
            raise GoalRejected("no odometry yet: the planner does not know where the vehicle is")
        if self._goal is not None or self._finished is not None:
            raise GoalRejected("another goal is active: wait for its end, or cancel it")
        knot = self._stop.end(self._knot.stamp)
        if isinstance(goal, JointGoal):
            check_joint_goal(goal, knot.configuration[VEHICLE:], self._solver.joints)
            accepted = JointMotion(goal, knot.configuration, knot.stamp, self._config.step_s)
        else:
            accepted = self._follower(goal, knot)
        self._goal = accepted
        self._planned_error = self._max_planned_error = 0.0

    def _follower(self, goal: PathGoal, knot: Knot) -> PathFollower:
        check_path_goal(goal)
        position, rotation = tool_pose(self._solver.model, knot.configuration)
        quaternion = matrix_to_quat(rotation)
        check_start(goal, position, quaternion, self._config)
        path = EndEffectorPath(goal)
        joined = JoinedPath(path, position, quaternion, self._config.approach_s)
        check_reachable(joined, self._solver, knot.configuration, self._config.step_s)
        return PathFollower(self._solver, joined, knot.stamp, self._config.step_s)

    def cancel(self) -> None:
        """Give the goal up and come to rest smoothly; without a goal nothing happens."""
        if self._goal is not None:
            self._end_goal(False, "cancelled")

    @property
    def end_effector(self) -> tuple[Array, Array]:
        """Position (3,) and quaternion (4,) of the tool where the next goal would begin.

        Raises SignalError before the first step.
        """
        if self._stop is None or self._knot is None:
            raise SignalError("motion planner: no step yet, the end effector is not known")
        position, rotation = tool_pose(self._solver.model, self._knot.configuration)
        return position, matrix_to_quat(rotation)

    def step(self, stamp: int, odometry: Odometry, joints: JointStates) -> PlannerStep:
        """Plan up to two steps after `stamp` ns; the references of what is new, in order.

        Raises SignalError where the stamp does not advance or a signal is malformed.
        """
        self._check(stamp, odometry, joints)
        self._tick = stamp
        if self._knot is None:
            self._hold_at(stamp, odometry, joints)
        self._diagnostics = None
        references: list[Reference] = []
        while self._knot.stamp < stamp + 2 * self._step:
            references.append(self._plan())
        feedback = self._feedback(stamp, odometry, joints)
        if self._goal is not None and stamp >= self._goal.end:
            self._complete()
        finished, self._finished = self._finished, None
        return PlannerStep(tuple(references), feedback, finished, self._diagnostics)

    def _plan(self) -> Reference:
        """The segment after the last knot."""
        start, samples = self._knot, None
        if self._goal is not None and self._goal.start <= start.stamp < self._goal.end:
            samples = self._along_goal(start)
        if samples is None:
            self._knot, samples = self._stop.plan(start, self._times)
        return reference(self._solver.model, start.stamp, self._times, samples)

    def _along_goal(self, start: Knot) -> Samples | None:
        """The goal's next segment; None, the goal being given up, where it cannot be reached."""
        goal = self._goal
        if isinstance(goal, JointMotion):
            self._knot, samples = goal.plan(start, self._times)
            self._stop = Stop(self._solver, self._knot, self._config.step_s)
            return samples
        step = goal.plan(start, self._times)
        self._diagnostics = StepDiagnostics.of(self._config.method, self._solver, step)
        self._planned_error = step.planned_error
        if not step.choice.valid:
            self._end_goal(False, _unreachable(goal, step, self._config))
            return None
        if goal.path.joined(goal.elapsed(start.stamp)):
            self._max_planned_error = max(self._max_planned_error, step.planned_error)
        self._knot = step.knot
        anchor = None
        if step.knot.stamp >= goal.end:
            anchor = goal.path.sample(goal.path.duration)
        self._stop = Stop(self._solver, self._knot, self._config.step_s, anchor)
        return step.samples

    def _complete(self) -> None:
        self._end_goal(True, "the end of the goal is reached")

    def _end_goal(self, success: bool, message: str) -> None:
        self._finished = GoalResult(success, message, self._max_planned_error)
        self._goal = None

    def _feedback(self, stamp: int, odometry: Odometry, joints: JointStates) -> GoalFeedback | None:
        goal = self._goal
        if goal is None:
            return None
        elapsed = goal.elapsed(stamp)
        if isinstance(goal, JointMotion):
            duration, c = goal.duration, goal.sample(np.array([elapsed])).configuration[0]
            wanted = tool_pose(self._solver.model, c)[0]
        else:
            duration, wanted = goal.path.duration, goal.path.goal.sample(elapsed).position
        actual = end_effector(
            self._solver.model, odometry.position, odometry.quaternion, joints.position
        )[0]
        return GoalFeedback(
            stamp=stamp,
            elapsed=elapsed,
            duration=duration,
            planned_error=self._planned_error,
            tracking_error=float(np.linalg.norm(actual - wanted)),
        )

    def _hold_at(self, stamp: int, odometry: Odometry, joints: JointStates) -> None:
        """Begin at rest in the pose of the first tick, level."""
        x, y, z, w = odometry.quaternion
        yaw = np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        configuration = np.concatenate([odometry.position, [yaw], joints.position])
        self._knot = Knot.at_rest(stamp, configuration)
        self._stop = Stop(self._solver, self._knot, self._config.step_s)

    def _check(self, stamp: int, odometry: Odometry, joints: JointStates) -> None:
        if self._tick is not None and stamp <= self._tick:
            raise SignalError(
                f"motion planner: stamp {to_seconds(stamp):g} s does not follow"
                f" {to_seconds(self._tick):g} s; stamps must increase"
            )
        count = self._solver.size - VEHICLE
        for name, value, shape in (
            ("odometry position", odometry.position, (3,)),
            ("odometry quaternion", odometry.quaternion, (4,)),
            ("joint position", joints.position, (count,)),
        ):
            if np.shape(value) != shape:
                raise SignalError(
                    f"motion planner: {name} has shape {np.shape(value)}, needed is {shape}"
                )
            if not np.all(np.isfinite(value)):
                raise SignalError(f"motion planner: {name} = {value} is not finite")


def _sample_times(config: PlannerConfig) -> Array:
    count = max(1, round(config.step_s / config.sample_s))
    return np.linspace(0.0, config.step_s, count + 1)


def _unreachable(goal: PathFollower, step, config: PlannerConfig) -> str:
    time = goal.elapsed(step.knot.stamp)
    allowed = config.projection.position_tolerance_m
    return (
        f"given up at t = {time:g} s: the nearest reachable point is {step.choice.distance:.4g} m"
        f" away, allowed {allowed:g} m"
    )
