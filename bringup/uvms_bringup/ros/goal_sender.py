"""Goals of a run to the action servers of the planner."""

import uuid
from collections.abc import Callable, Sequence
from typing import Any

from rclpy.action import ActionClient
from rclpy.node import Node
from unique_identifier_msgs.msg import UUID

from uvms_core import topics
from uvms_core.messages import to_message
from uvms_core.ros.convert import action_class, to_ros
from uvms_core.ros.request import Request
from uvms_core.signals import Goal


class GoalSender:
    """Asks the planner for goals, with one client for each action.

    Args:
        node: that asks.
        joint_names: in the vehicle's order, for goals that name the joints.
        on_feedback: called with each message of feedback.
    """

    def __init__(
        self, node: Node, joint_names: Sequence[str], on_feedback: Callable[[Any], None]
    ) -> None:
        self._node, self._joint_names, self._on_feedback = node, joint_names, on_feedback
        self._clients: dict[str, tuple[ActionClient, Any]] = {}

    def is_ready(self, goal: Goal) -> bool:
        """Whether the server of the goal's action is found."""
        ready: bool = self._client_of(goal)[0].server_is_ready()
        return ready

    def request(self, goal: Goal) -> Request:
        """The question whether the planner takes the goal; its answer is a handle.

        Every repetition has the same id, so that no second goal is created.
        """
        client, cls = self._client_of(goal)
        message = to_ros(cls.Goal, to_message(topics.action_of(goal), goal, self._joint_names))
        goal_id = UUID(uuid=list(uuid.uuid4().bytes))
        return Request(
            lambda: client.send_goal_async(message, self._on_feedback, goal_id),
            client.server_is_ready,
        )

    def _client_of(self, goal: Goal) -> tuple[ActionClient, Any]:
        """The client of a goal's action, and the action's class."""
        action = topics.action_of(goal)
        if action.name not in self._clients:
            cls = action_class(action)
            self._clients[action.name] = ActionClient(self._node, cls, action.name), cls
        return self._clients[action.name]


def refusal(handle: Any, request: Request, reason: str) -> str | None:
    """Why the planner rejected a goal; None where it took it.

    A server refuses an id that it already has: it accepted the goal the first time.
    """
    if handle.accepted or (request.times_asked > 1 and not reason):
        return None
    return reason or "no reason given"
