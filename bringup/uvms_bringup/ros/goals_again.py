"""The goals of a recorded run, for a planner that gets the run's inputs again.

A planner in lockstep keeps its ticks between the end of a goal and the answer to the next one, so
each goal begins at the tick at which it began in a run in lockstep, whatever time its way takes.
"""

from collections.abc import Sequence
from typing import Any

from rclpy.node import Node
from std_srvs.srv import SetBool

from uvms_bringup.agenda import Agenda, Goals
from uvms_bringup.errors import RunError
from uvms_bringup.ros.conductor import GOAL_STATES
from uvms_bringup.ros.goal_sender import GoalSender, refusal
from uvms_core import topics
from uvms_core.ros.request import Request

UNTIMED = 0
"""Stamp in an agenda of which nobody reads the times."""


class GoalsAgain:
    """Sends each goal when the one before it has succeeded; every method returns at once.

    Args:
        node: that asks.
        goals: of the run, in turn.
        joint_names: in the vehicle's order.
    """

    def __init__(self, node: Node, goals: Goals, joint_names: Sequence[str]) -> None:
        self._agenda = Agenda(goals)
        self._sender = GoalSender(node, joint_names, lambda feedback: None)
        self._sent: Request | None = None
        self._wait = node.create_client(SetBool, f"{topics.MOTION_PLANNER}/wait_for_goals")
        self._call = self._to_wait(True)

    @property
    def is_awaited(self) -> bool:
        """Whether the planner keeps its ticks, or is about to, until a goal is answered."""
        return self._agenda.due is not None

    def begin(self) -> bool:
        """Tell the planner to wait for goals; True once it does, or where there are none."""
        return not self._agenda.remaining or self._call.answer() is not None

    def go_on(self) -> None:
        """Ask for the goal that is due, and take the planner's answer.

        Raises:
            RunError: the planner rejected the goal.
        """
        goal = self._agenda.due
        if goal is None:
            return
        self._sent = self._sent or self._sender.request(goal)
        handle = self._sent.answer()
        if handle is not None:
            self._take_answer(handle, self._sent)

    def _take_answer(self, handle: Any, request: Request) -> None:
        self._sent = None
        if (why := refusal(handle, request, "")) is not None:
            raise RunError(f"the planner rejected a goal of the recorded run: {why}")
        self._agenda.begin(UNTIMED)
        handle.get_result_async().add_done_callback(self._take_result)
        if not self._agenda.remaining:
            self._call = self._to_wait(False)
            self._call.answer()

    def _take_result(self, done: Any) -> None:
        answer = done.result()
        self._agenda.end(UNTIMED, GOAL_STATES.get(answer.status, "aborted"), answer.result.message)

    def _to_wait(self, waits: bool) -> Request:
        request = SetBool.Request(data=waits)
        return Request(lambda: self._wait.call_async(request), self._wait.service_is_ready)
