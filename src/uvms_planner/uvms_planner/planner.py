"""The motion planner: one call each step gives the motion of vehicle and joints one step ahead."""

from collections import deque
from copy import copy
from dataclasses import dataclass

import numpy as np

from uvms_core import checks
from uvms_core.end_effector_path import PathSample
from uvms_core.errors import SignalError
from uvms_core.signals import (
    Array,
    DisturbanceBudget,
    Goal,
    JointStates,
    Odometry,
    Reference,
    to_nanoseconds,
)
from uvms_core.vehicle import Vehicle
from uvms_dynamics import end_effector
from uvms_dynamics.joint_prediction import carried_by_rate
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner.config import PlannerConfig
from uvms_planner.errors import GoalRejected
from uvms_planner.follow import PathFollower
from uvms_planner.led_motion import LedMotion, led_to
from uvms_planner.on_path import FollowedStep, OnPath
from uvms_planner.planned_path import PlannedPath
from uvms_planner.projection import tool_pose
from uvms_planner.proposal import Motion, Progress, Proposal, silent
from uvms_planner.report import GoalFeedback, GoalResult, PlannerStep, StepDiagnostics, why_not
from uvms_planner.safe_stop import LedStop, safe_stop
from uvms_planner.segment import Knot, Samples, reference
from uvms_planner.solver import StepSolver
from uvms_planner.stop import Stop
from uvms_planner.straight_motion import StraightMotion
from uvms_planner.timed_motion import TimedMotion
from uvms_planner.whole_path.window import TimedPlan

PREEMPTED = "pre-empted by a new goal"
"""Why a goal ended in whose place another one began."""


@dataclass
class _Plan:
    """How far the motion is planned, and how it would come to rest from there."""

    knot: Knot
    stop: Stop | LedStop


class MotionPlanner:
    """Plans vehicle pose (x, y, z, psi) and joints so that the end effector follows a goal.

    At the tick t the segment [t + step, t + 2 step] is planned, so that the loop never waits for
    the planner; the first tick t_0 also gives the segment [t_0, t_0 + step], at rest. Without
    a goal the vehicle holds the pose of the first tick, level, and the joints theirs.
    """

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int):
        self._config = config
        self._joint_names = vehicle.joint_names
        self._solver = StepSolver(vehicle, config, seed)
        self._step = to_nanoseconds(config.step_s)
        self._times = _sample_times(config)
        self._tick: int | None = None
        self._plan: _Plan | None = None
        self._goal: Motion | None = None
        self._way: StraightMotion | LedMotion | None = None  # to where the goal begins, or led to
        self._proposed = False
        self._finished: deque[GoalResult] = deque()  # which no step has told yet
        self._planned_error = 0.0
        self._max_planned_error = 0.0
        self._diagnostics: StepDiagnostics | None = None

    def inform(self, budget: DisturbanceBudget) -> None:
        """Plan from now on with what the gripper holds and what the thrusters have left."""
        if self._solver.take(budget) and isinstance(self._goal, PlannedPath):
            self._goal.reconsider()

    def accept(self, goal: Goal, progress: Progress = silent) -> None:
        """Begin a goal with the first segment that is not planned yet, or once at rest.

        A goal that is active ends as pre-empted. Raises GoalRejected where the goal is malformed,
        cannot be followed, or comes too early (no odometry yet); an active one then goes on.
        """
        proposal = self.propose(goal)
        try:
            proposal.work(progress)
        except BaseException:
            self.withdraw()
            raise
        self.begin(proposal)

    def propose(self, goal: Goal, lead: float = 0.0) -> Proposal:
        """Check a goal and say what there is to be planned for it, which `begin` waits for.

        `Proposal.work` takes its time and touches nothing of the planner, so that it may run beside
        the steps; until `begin` or `withdraw` no other goal is taken. It is planned from where the
        motion would be at rest if `begin` came in `lead` s. Raises as `accept`.
        """
        if self._plan is None:
            raise GoalRejected("no odometry yet: the planner does not know where the vehicle is")
        if self._proposed:
            raise GoalRejected("another goal is being planned: wait for its answer")
        proposal = Proposal(goal, self._rest_in(lead), self._solver, self._plan.knot)
        self._proposed = True
        return proposal

    def withdraw(self) -> None:
        """Nothing came of what was proposed."""
        self._proposed = False

    def lateness(self, proposal: Proposal) -> float:
        """How far the vehicle would come to rest from where a path was planned from, m.

        0 for what `begin` plans again in no time.
        """
        if self._plan is None or proposal.plan is None:
            return 0.0
        return proposal.distance(self._rest_in(0.0))

    def begin(self, proposal: Proposal) -> None:
        """Begin what was proposed with the first segment that is not planned yet, or at rest.

        A goal that is active ends as pre-empted. Raises GoalRejected where the motion has gone on
        to where it cannot begin from; an active goal then goes on.
        """
        self._proposed = False
        if self._plan is None or not proposal.is_of(self._solver):
            raise GoalRejected("the planner restarted while the goal was being planned")
        stop = self._stopping(self._plan)
        way, motion = proposal.motion_from(stop.end(self._plan.knot.stamp))
        self._plan.stop = stop
        if self._goal is not None:
            self._end_goal(False, PREEMPTED)
        self._way, self._goal = way, motion
        self._planned_error = self._max_planned_error = 0.0

    def lead(self, target: Array) -> None:
        """Lead the tool to a target (3,) m in map_ned, from where the motion is planned to be next.

        There it rests until another target or a goal comes. Raises GoalRejected before the first
        step, while a goal is active, or where the target cannot be reached within the limits; the
        motion then goes on as it was.
        """
        if self._plan is None or self._goal is not None:
            why = "no odometry yet" if self._plan is None else "a goal is active"
            raise GoalRejected(f"target: {why}")
        knot, step = self._plan.knot, self._config.step_s
        before = self._way if isinstance(self._way, LedMotion) else None
        self._way = led_to(self._solver, knot, target, step, before)

    def _rest_in(self, lead: float) -> Knot:
        """Where the motion would be at rest if its goal ended in `lead` s."""
        if self._plan is None:
            raise SignalError("motion planner: no step yet")
        knot = self._plan.knot
        if lead > 0.0 and (ahead := self._ahead(knot.stamp + to_nanoseconds(lead))) is not None:
            return self._stop_from(ahead).end(ahead.stamp)
        return self._stopping(self._plan).end(knot.stamp)

    def _stopping(self, plan: _Plan) -> Stop | LedStop:
        """How the motion comes to rest if its goal ends now."""
        motion = self._way if _covers(self._way, plan.knot.stamp) else self._goal
        if motion is None or not _covers(motion, plan.knot.stamp):
            return plan.stop
        if isinstance(motion, PathFollower):  # it takes too long to see where it would go
            return plan.stop
        if not isinstance(plan.stop, Stop):
            raise AssertionError("a stop with a lead is of a goal that has ended")
        tried = copy(motion)  # the goal may go on, and remembers its last step

        def follow(knot: Knot) -> tuple[Knot, Samples]:
            step = tried.plan(knot, self._times)
            return step if isinstance(step, tuple) else (step.knot, step.samples)

        return safe_stop(plan.stop, plan.knot, follow, motion.end, self._solver, self._times)

    def _ahead(self, stamp: int) -> Knot | None:
        """The knot at a stamp as the present goal has it; None where nobody can know."""
        motion = self._goal if self._way is None or stamp >= self._way.end else self._way
        if motion is None or stamp < motion.start:
            return None
        planned = motion.motion if isinstance(motion, PlannedPath) else motion
        if not isinstance(planned, TimedPlan | TimedMotion):
            return None
        samples = planned.sample(np.array([motion.elapsed(stamp)]))
        c, rate, acceleration = (
            part[0] for part in (samples.configuration, samples.rate, samples.acceleration)
        )
        return Knot(stamp, c, rate, acceleration, np.zeros_like(c))

    def cancel(self) -> None:
        """Abandon the goal and come to rest smoothly; without a goal nothing happens."""
        if self._goal is not None and self._plan is not None:
            self._plan.stop = self._stopping(self._plan)
            self._end_goal(False, "cancelled")

    @property
    def has_goal(self) -> bool:
        """Whether a goal is active, or a step is yet to say how one ended."""
        return self.answers_owed > 0

    @property
    def answers_owed(self) -> int:
        """Goals that have begun and whose end no step has told."""
        return len(self._finished) + (self._goal is not None)

    def give_up(self, reason: str) -> None:
        """Say with a step to come that a goal of a planner before this one came to nothing."""
        self._finished.append(GoalResult(False, reason, 0.0))

    @property
    def end_effector(self) -> tuple[Array, Array]:
        """Position (3,) and quaternion (4,) of the tool where the next goal would begin.

        Raises SignalError before the first step.
        """
        if self._plan is None:
            raise SignalError("motion planner: no step yet, the end effector is not known")
        knot = self._rest_in(0.0)
        position, rotation = tool_pose(self._solver.model, knot.configuration)
        return position, matrix_to_quat(rotation)

    def step(self, stamp: int, odometry: Odometry, joints: JointStates) -> PlannerStep:
        """Plan up to two steps after `stamp` ns; the references of what is new, in order.

        Raises SignalError where the stamp does not advance or a signal is malformed.
        """
        self._check(stamp, odometry, joints)
        self._tick = stamp
        self._diagnostics = None
        if self._plan is None:
            self._plan = self._hold_at(stamp, odometry, joints)
        references: list[Reference] = []
        while self._plan.knot.stamp < stamp + 2 * self._step:
            references.append(self._extend(self._plan))
        feedback = self._feedback(stamp, odometry, joints)
        if self._goal is not None and stamp >= self._goal.end:
            self._end_goal(True, "the end of the goal is reached")
        finished = self._finished.popleft() if self._finished else None
        return PlannerStep(tuple(references), feedback, finished, self._diagnostics)

    def _hold_at(self, stamp: int, odometry: Odometry, joints: JointStates) -> _Plan:
        """Begin at rest in the pose of the first tick, level."""
        yaw = _yaw_of(odometry)
        q = carried_by_rate(joints, stamp)
        configuration = np.concatenate([odometry.position, [yaw], q])
        knot = Knot.at_rest(stamp, configuration)
        return _Plan(knot, self._stop_from(knot))

    def _stop_from(self, knot: Knot, anchor: PathSample | None = None) -> Stop:
        return Stop(self._solver, knot, self._config.step_s, anchor)

    def _extend(self, plan: _Plan) -> Reference:
        """The segment after the last knot: the goal's or of the way to it, or towards rest."""
        stamp, samples = plan.knot.stamp, None
        motion = self._way if _covers(self._way, stamp) else self._goal
        if motion is not None and _covers(motion, stamp):
            if isinstance(motion, TimedMotion):
                samples = self._along(plan, motion)
            else:
                samples = self._along_path(plan, motion)
        if samples is None:
            plan.knot, samples = plan.stop.plan(plan.knot, self._times)
        return reference(self._solver.model, stamp, self._times, samples)

    def _along(self, plan: _Plan, motion: TimedMotion) -> Samples:
        plan.knot, samples = motion.plan(plan.knot, self._times)
        plan.stop = self._stop_from(plan.knot)
        return samples

    def _along_path(self, plan: _Plan, goal: OnPath) -> Samples | None:
        """The path's next segment; None, with the goal aborted, where it cannot be reached."""
        begin = goal.elapsed(plan.knot.stamp)
        step = goal.plan(plan.knot, self._times)
        self._diagnostics = StepDiagnostics.of(self._config.method, self._solver, step)
        self._planned_error = step.planned_error
        if not step.choice.valid:
            self._end_goal(False, _unreachable(goal, step, self._config))
            return None
        if goal.path.joined(begin):
            self._max_planned_error = max(self._max_planned_error, step.planned_error)
        plan.knot = step.knot
        over = step.knot.stamp >= goal.end
        plan.stop = self._stop_from(
            step.knot, goal.path.sample(goal.path.duration) if over else None
        )
        return step.samples

    def _end_goal(self, success: bool, message: str) -> None:
        self._finished.append(GoalResult(success, message, self._max_planned_error))
        self._goal = self._way = None

    def _feedback(self, stamp: int, odometry: Odometry, joints: JointStates) -> GoalFeedback | None:
        goal = self._goal
        if goal is None:
            return None
        elapsed, to_go = goal.elapsed(stamp), (np.nan, np.nan)
        if isinstance(goal, TimedMotion):
            configuration = goal.sample(np.array([elapsed])).configuration[0]
            duration, wanted = goal.duration, tool_pose(self._solver.model, configuration)[0]
            if isinstance(goal, StraightMotion):
                to_go = _to_go(odometry, goal.ends[1])
        else:
            duration, wanted = goal.path.duration, goal.path.goal.sample(elapsed).position
        actual = end_effector(
            self._solver.model,
            odometry.position,
            odometry.quaternion,
            carried_by_rate(joints, stamp),
        )[0]
        return GoalFeedback(
            stamp=stamp,
            elapsed=elapsed,
            duration=duration,
            planned_error=self._planned_error,
            tracking_error=float(np.linalg.norm(actual - wanted)),
            distance=to_go[0],
            turn=to_go[1],
        )

    def _check(self, stamp: int, odometry: Odometry, joints: JointStates) -> None:
        if self._tick is not None:
            checks.later("stamp", stamp, self._tick, "the last step's")
        checks.check("odometry", odometry)
        checks.check("joint_states", joints, n=self._joint_names)


def _sample_times(config: PlannerConfig) -> Array:
    count = max(1, round(config.step_s / config.sample_s))
    return np.linspace(0.0, config.step_s, count + 1)


def _covers(motion: Motion | None, stamp: int) -> bool:
    """Whether a motion has a segment from `stamp` on."""
    return motion is not None and motion.start <= stamp < motion.end


def _yaw_of(odometry: Odometry) -> float:
    x, y, z, w = odometry.quaternion
    return float(np.arctan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)))


def _to_go(odometry: Odometry, end: Array) -> tuple[float, float]:
    """Distance (m) and angle about the vertical axis (rad) from a configuration (m,)."""
    turn = end[3] - _yaw_of(odometry)
    distance = float(np.linalg.norm(odometry.position - end[:3]))
    return distance, float(abs(np.arctan2(np.sin(turn), np.cos(turn))))


def _unreachable(goal: OnPath, step: FollowedStep, config: PlannerConfig) -> str:
    return f"aborted at t = {goal.elapsed(step.knot.stamp):g} s: {why_not(step.choice, config)}"
