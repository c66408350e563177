"""Node `motion_planner`: plans vehicle and joints every step; serves the actions for goals."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from threading import Thread
from typing import Any

from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.task import Future
from std_srvs.srv import SetBool

from uvms_core import diagnostics, topics
from uvms_core.errors import UvmsError
from uvms_core.messages import from_message
from uvms_core.ros.convert import action_class
from uvms_core.ros.main import main_of
from uvms_core.ros.part_node import PartNode
from uvms_core.signals import NANOSECONDS, Goal, ToolTarget, to_seconds
from uvms_core.tick_gate import Tick
from uvms_core.timeline import Jump
from uvms_core.topics import Action
from uvms_planner import MotionPlanner, PlannerConfig, PlannerStep
from uvms_planner.nodes.turns import Turns
from uvms_planner.part import PlannerPart
from uvms_planner.proposal import Proposal


@dataclass(frozen=True)
class _Planning:
    """The goal that is being planned beside the ticks, and when that is over."""

    goal: Any
    ended: Future


@dataclass(frozen=True)
class _Begun:
    """A goal whose end its client has not been told."""

    type: Any
    handle: ServerGoalHandle
    outcome: Future


PLANNINGS = 3
"""Times that a path is planned at most where the vehicle goes on meanwhile."""


class MotionPlannerNode(PartNode):
    """odometry and joint_states in, reference out, every planner step.

    Actions: `follow_end_effector_path`, `follow_joint_trajectory` and `go_to_pose`. A goal that
    cannot be followed is rejected; the reason is logged and stands on /diagnostics. A goal that is
    accepted ends the one before it, which goes on until then.
    """

    role = topics.MOTION_PLANNER
    configurations = (PlannerConfig,)
    part: PlannerPart

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._begun: list[_Begun] = []  # the last one is active, the others have just ended
        self._planning: _Planning | None = None
        self._stamp = 0
        self._accepted = 0
        self._ready = Future(executor=self.executor)  # once there has been an odometry
        self._servers = [self._serve(action) for action in topics.ACTIONS]
        self._turns = Turns(self._plan_tick)
        self.create_service(SetBool, f"{self.role}/wait_for_goals", self._answer_wait)
        self._target: ToolTarget | None = None  # the newest, that no tick has taken
        self.listen(topics.END_EFFECTOR_TARGET, self._take_target)

    def make_part(self) -> PlannerPart:
        """The planner with the method that the parameters name."""
        return PlannerPart(self.vehicle, self.config(PlannerConfig), self.seed, self.period)

    def take_tick(self, tick: Tick) -> None:
        """Plan, or wait for a goal with that."""
        self._turns.take(tick)

    def _plan_tick(self, tick: Tick) -> None:
        """Plan; every planner step is reported, and the goal's client hears of it."""
        self._lead(tick.stamp)
        super().take_tick(tick)
        self._stamp, plan = tick.stamp, self.part.plan
        if plan is None:
            return
        if not self._ready.done():
            self._ready.set_result(None)
            self._turns.goal_is_due()
        self._answer_goal(plan)
        self.report(tick.stamp, step_ms=self.step_ms, **plan.diagnostics())

    def report(self, stamp: int, *args: Any, **values: Any) -> None:
        """As every node; while ticks are kept it speaks of the last that was not."""
        newest = min(stamp, self._stamp) if self._turns.is_waiting else stamp
        super().report(newest, *args, **values)

    def more_counts(self) -> dict[str, int]:
        """Goals that were accepted, whoever sent them."""
        return {**super().more_counts(), diagnostics.GOALS_ACCEPTED: self._accepted}

    def _answer_wait(self, request: SetBool.Request, response: SetBool.Response) -> Any:
        """Whether to wait for a goal whenever there is none, which lockstep alone can."""
        response.success = self.lockstep or not request.data
        if response.success:
            self.guard(partial(self._turns.wait, request.data))
        else:
            response.message = "in real time nobody waits: time goes on between two goals"
        return response

    def _take_target(self, target: ToolTarget) -> None:
        self._target = target

    def _lead(self, stamp: int) -> None:
        """Lead the tool to the newest target; where that cannot be, the motion goes on as it is."""
        target, self._target = self._target, None
        if target is None:
            return
        try:
            self.part.planner.lead(target.position)
        except UvmsError as fault:
            self.complain(stamp, diagnostics.WARN, str(fault))

    def _answer_goal(self, plan: PlannerStep) -> None:
        """Feedback is of the newest goal; ends come in the order of the goals."""
        if self._begun and plan.feedback is not None:
            newest = self._begun[-1]
            newest.handle.publish_feedback(_filled(newest.type.Feedback(), plan.feedback))
        if self._begun and plan.finished is not None:
            self._begun.pop(0).outcome.set_result(plan.finished)
            if plan.finished.success and not self._begun:
                self._turns.goal_is_due()

    def _serve(self, action: Action) -> ActionServer:
        cls = action_class(action)
        return ActionServer(
            self,
            cls,
            action.name,
            execute_callback=_not_begun,
            goal_callback=partial(self._admit_goal, action),
            handle_accepted_callback=lambda handle: self._begin(cls, handle),
            cancel_callback=self._cancel,
        )

    async def _admit_goal(self, action: Action, goal: Any) -> GoalResponse:
        if not self._ready.done():
            self.get_logger().info("a goal waits for the first odometry")
            await self._ready
        if self._planning is not None and goal == self._planning.goal:
            return await self._refuse_repetition(self._planning)
        try:
            await self._plan_for(action, goal)
        except UvmsError as fault:
            self.get_logger().error(f"goal rejected: {fault}")
            self.report(self._stamp, diagnostics.ERROR, str(fault))
            self.guard(self._turns.goal_is_answered)
            return GoalResponse.REJECT
        self._accepted += 1
        return GoalResponse.ACCEPT

    async def _plan_for(self, action: Action, goal: Any) -> None:
        """Begin the goal's motion once it is planned, beside the ticks."""
        planner = self.part.planner
        wanted = from_message(action, goal, self.vehicle.joint_names)
        proposal = planner.propose(wanted)
        planning = self._planning = _Planning(goal, Future(executor=self.executor))
        try:
            proposal = await self._worked_out(planner, wanted, proposal)
        except BaseException:
            planner.withdraw()
            raise
        finally:
            self._planning = None
            planning.ended.set_result(None)
        self.part.planner.begin(proposal)

    async def _worked_out(self, planner: MotionPlanner, wanted: Goal, first: Proposal) -> Proposal:
        """The proposal, planned; again from farther on where the vehicle has gone on meanwhile."""
        proposal, attempt = first, 1
        while True:
            began = self._stamp
            await self._beside(partial(proposal.work, self._say_progress))
            near = planner.lateness(proposal) <= self.config(PlannerConfig).start_tolerance_m
            if near or attempt == PLANNINGS:
                return proposal
            planner.withdraw()
            proposal = planner.propose(wanted, to_seconds(self._stamp - began))
            attempt += 1

    async def _refuse_repetition(self, planning: _Planning) -> GoalResponse:
        """A client without an answer asks again; the one answer is that to its first question.

        The action server would refuse this one itself if the first were accepted already.
        """
        await planning.ended
        self.get_logger().info("the same goal again while it was being planned: answered once")
        return GoalResponse.REJECT

    async def _beside(self, work: Callable[[], None]) -> None:
        """Do work that takes its time in a thread, while the ticks go on."""
        done: Future = Future(executor=self.executor)

        def run() -> None:
            try:
                work()
            except BaseException as fault:
                done.set_exception(fault)
            else:
                done.set_result(None)

        Thread(target=run, name="planning", daemon=True).start()
        await done

    def _say_progress(self, share: float, text: str) -> None:
        """How far planning is, at most once a second."""
        self.get_logger().info(f"{text}: {share:.0%}", throttle_duration_sec=1.0)

    def _begin(self, cls: Any, handle: ServerGoalHandle) -> None:
        self._begun.append(_Begun(cls, handle, Future(executor=self.executor)))
        handle.execute(partial(self._execute, self._begun[-1]))
        self.guard(self._turns.goal_is_answered)

    def _cancel(self, handle: ServerGoalHandle) -> CancelResponse:
        """Only the newest goal moves anything; those before it have ended."""
        if not self._begun or self._begun[-1].handle.goal_id != handle.goal_id:
            return CancelResponse.REJECT
        self.part.planner.cancel()
        return CancelResponse.ACCEPT

    def on_time_jump(self, jump: Jump) -> None:
        """Time has jumped: a goal in progress is aborted with that reason."""
        super().on_time_jump(jump)
        self._stamp = jump.after
        self._turns.forget()

    async def _execute(self, begun: _Begun, handle: ServerGoalHandle) -> Any:
        finished = await begun.outcome
        if handle.is_cancel_requested:
            handle.canceled()
        elif finished.success:
            handle.succeed()
        else:
            handle.abort()
        return _filled(begun.type.Result(), finished)


def _not_begun(handle: ServerGoalHandle) -> Any:
    """Never: each goal is executed by what `_begin` gives it."""
    raise AssertionError(f"goal {handle.goal_id} was not begun")


def _filled(msg: Any, source: Any) -> Any:
    for name in msg.get_fields_and_field_types():
        value = getattr(source, name)
        if name == "stamp":
            msg.stamp.sec, msg.stamp.nanosec = divmod(value, NANOSECONDS)
        else:
            setattr(msg, name, value)
    return msg


def main(args=None) -> int:
    """`ros2 run uvms_planner motion_planner`."""
    return main_of(MotionPlannerNode, args)


if __name__ == "__main__":
    raise SystemExit(main())
