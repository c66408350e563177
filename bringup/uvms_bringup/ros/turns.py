"""Simulated time stands still in lockstep from the end of a goal until the next one has begun.

How long a goal is on its way to the planner, and how long it is planned, is wall time. If the
vehicle went on meanwhile no two runs were alike, and none was like the simulation without ROS,
where the next goal begins in the tick in which the one before it has ended.
"""

from collections import deque
from typing import Any

from rclpy.node import Node
from std_srvs.srv import SetBool

from uvms_core import topics
from uvms_core.ros.request import Request

FIND_S = 2.0
"""Wall time in which the service of a planner is found that has it, s."""


class Turns:
    """The planner holds its steps, and the plant its time, between two goals of a run.

    Every method returns at once; the calls are made one after the other by `settled`.

    Args:
        node: that asks.
        pause: client of the plant's service.
    """

    def __init__(self, node: Node, pause: Any) -> None:
        self._pause = pause
        self._wait = node.create_client(SetBool, f"{topics.MOTION_PLANNER}/wait_for_goals")
        self._calls: deque[Request] = deque()
        self._begun = self._held = False
        self.pauses = 0
        """How often this has held the plant's time."""

    def is_possible(self) -> bool:
        """Whether the planner is one that can wait."""
        ready: bool = self._wait.service_is_ready()
        return ready

    def begin(self) -> None:
        """From now on the planner waits for a goal while it has none."""
        self._begun = True
        self._call(self._wait, True)

    def hold(self) -> bool:
        """Let the plant stand; True once it does, or where there are no turns to take."""
        if self._begun and not self._held:
            self._held = True
            self.pauses += 1
            self._call(self._pause, True)
        return self.settled()

    def go_on(self, more: bool) -> None:
        """Let time go on; `more`: whether a goal comes after the one that has been answered."""
        if self._begun and not more:
            self._begun = False
            self._call(self._wait, False)
        if self._held:
            self._held = False
            self._call(self._pause, False)

    def settled(self) -> bool:
        """Make the next call; True once all have been answered."""
        while self._calls and self._calls[0].answer() is not None:
            self._calls.popleft()
        return not self._calls

    def _call(self, client: Any, data: bool) -> None:
        request = SetBool.Request(data=data)
        self._calls.append(Request(lambda: client.call_async(request), client.service_is_ready))
