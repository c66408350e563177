"""A client of one of the planner's actions: sends a goal, takes its feedback and result, cancels.

What every client has in common; `pose_client.py` and `path_client.py` beside it are two of them.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any

import numpy as np
import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from numpy.typing import NDArray
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

Array = NDArray[np.float64]
FRAMES = {"map_ned": np.eye(3), "map": np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])}
"""Components in map_ned (north, east, down) to those in each frame; map is east, north, up."""
ENDINGS = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_CANCELED: "cancelled",
    GoalStatus.STATUS_ABORTED: "aborted",
}


class GoalClient(ABC, Node):
    """Client of an action of the planner, with everything in `frame`."""

    def __init__(self, name: str, kind: Any, action: str, frame: str, **options: Any) -> None:
        """`kind` is the type of the action, `action` its name."""
        super().__init__(name, **options)
        self.frame = frame
        self.feedback: Any = None
        self.ending: str | None = None  # how the goal ended; "rejected" where it never began
        self.message = ""
        self._handle: Any = None
        self._cancelled = False
        self._client = ActionClient(self, kind, action)

    @property
    @abstractmethod
    def located(self) -> bool:
        """Whether it is known from where a goal would begin."""

    @property
    def ready(self) -> bool:
        """Whether the planner is there, and it is known from where a goal would begin."""
        return self.located and bool(self._client.server_is_ready())

    def ask(self, goal: Any) -> None:
        """Send a goal in `frame`."""
        goal.header.frame_id = self.frame
        asked = self._client.send_goal_async(goal, self._take_feedback)
        asked.add_done_callback(self._take_answer)

    def cancel(self) -> None:
        """Ask the planner to come to rest, now or as soon as it has accepted the goal."""
        self._cancelled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()

    def _take_answer(self, answer: Future) -> None:
        handle: Any = answer.result()
        if not handle.accepted:
            self.ending = "rejected"
            self.message = "the reason is on /diagnostics and in the planner's log"
            return
        self._handle = handle
        handle.get_result_async().add_done_callback(self._take_result)
        if self._cancelled:
            self.cancel()

    def _take_feedback(self, msg: Any) -> None:
        self.feedback = msg.feedback

    def _take_result(self, answer: Future) -> None:
        result: Any = answer.result()
        self.message = result.result.message
        self.ending = ENDINGS.get(result.status, f"status {result.status}")


def duration(seconds: float) -> Duration:
    """Seconds as a message."""
    nanoseconds = round(seconds * 1e9)
    return Duration(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)


def carry_out(
    make: Callable[[], GoalClient],
    send: Callable[[Any], None],
    words: Callable[[Any], str],
) -> int:
    """Send a goal as soon as that can be, print how it goes, and cancel it on Ctrl-C.

    `words` puts the feedback of the moment. 0 where the goal succeeded, else 1.
    """
    # rclpy's own handler would end the context on Ctrl-C, before the goal could be cancelled.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    client = make()
    try:
        try:
            _follow(client, send, words)
        except KeyboardInterrupt:
            client.cancel()
            while client.ending is None:
                rclpy.spin_once(client, timeout_sec=0.1)
    finally:
        rclpy.try_shutdown()
    print(f"{client.ending}: {client.message}")
    return 0 if client.ending == "succeeded" else 1


def _follow(client: GoalClient, send: Callable[[Any], None], words: Callable[[Any], str]) -> None:
    while not client.ready:
        rclpy.spin_once(client, timeout_sec=0.1)
    send(client)
    reported = 0.0
    while client.ending is None:
        rclpy.spin_once(client, timeout_sec=0.1)
        news = client.feedback
        if news is not None and news.elapsed >= reported:
            print(f"{news.elapsed:6.1f} of {news.duration:.1f} s, {words(news)}")
            reported = news.elapsed + 0.1 * news.duration
