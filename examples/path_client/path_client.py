"""Send a path of the end effector to a running vehicle, report how it goes, cancel it on Ctrl-C.

Start a vehicle first: uvms run manipulation --pace realtime --set goal={}. In another terminal:
python examples/path_client/path_client.py --frame map --radius 0.2 --period 60
"""

from argparse import ArgumentParser
from collections.abc import Sequence
from typing import Any

import numpy as np
import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point
from numpy.typing import NDArray
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from uvms_msgs.action import FollowEndEffectorPath
from uvms_msgs.msg import Reference

Array = NDArray[np.float64]
FRAMES = {"map_ned": np.eye(3), "map": np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])}
"""Components in map_ned (north, east, down) to those in each frame; map is east, north, up."""
POINTS_A_TURN = 120
ENDINGS = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_CANCELED: "cancelled",
    GoalStatus.STATUS_ABORTED: "aborted",
}


def circle(start: Array, radius: float, period: float) -> tuple[Array, Array]:
    """Times (k,) and positions (k, 3) of a horizontal circle through `start`, from rest to rest.

    The angle goes as 2 pi (10 u^3 - 15 u^4 + 6 u^5), so that speed and acceleration vanish at both
    ends.
    """
    u = np.linspace(0.0, 1.0, POINTS_A_TURN + 1)
    angle = 2 * np.pi * u**3 * (10 - 15 * u + 6 * u**2)
    offsets = np.column_stack([1 - np.cos(angle), np.sin(angle), 0 * angle])
    return period * u, start + radius * offsets


class PathClient(Node):
    """Client of the action `follow_end_effector_path`, with all positions in `frame`."""

    def __init__(self, frame: str, **options: Any) -> None:
        super().__init__("path_client", **options)
        self.frame = frame
        self.tool: Array | None = None  # (3,) m, where the planner has the tool, in `frame`
        self.feedback: Any = None
        self.ending: str | None = None  # how the goal ended; "rejected" where it never began
        self.message = ""
        self._handle: Any = None
        self._cancelled = False
        self._client = ActionClient(self, FollowEndEffectorPath, "follow_end_effector_path")
        self.create_subscription(
            Reference, "reference", self._take_reference, qos_profile_sensor_data
        )

    @property
    def ready(self) -> bool:
        """Whether the planner is there and has said where the tool is."""
        return self.tool is not None and self._client.server_is_ready()

    def send(self, times: Array, positions: Array, max_time_scale: float = 1.0) -> None:
        """Ask for a path through `positions` (k, 3) in `frame` at `times` (k,) s, from 0."""
        goal = FollowEndEffectorPath.Goal()
        goal.header.frame_id = self.frame
        goal.time_from_start = [_duration(time) for time in times.tolist()]
        goal.positions = [Point(x=x, y=y, z=z) for x, y, z in positions.tolist()]
        goal.max_time_scale = max_time_scale
        asked = self._client.send_goal_async(goal, self._take_feedback)
        asked.add_done_callback(self._take_answer)

    def cancel(self) -> None:
        """Ask the planner to come to rest, now or as soon as it has accepted the goal."""
        self._cancelled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()

    def _take_reference(self, msg: Reference) -> None:
        point = msg.points[-1].end_effector
        self.tool = FRAMES[self.frame] @ np.array([point.x, point.y, point.z])

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


def _duration(seconds: float) -> Duration:
    nanoseconds = round(seconds * 1e9)
    return Duration(sec=nanoseconds // 10**9, nanosec=nanoseconds % 10**9)


def follow(client: PathClient, radius: float, period: float) -> None:
    """Send the circle and print what comes back, until the goal has ended."""
    while not client.ready:
        rclpy.spin_once(client, timeout_sec=0.1)
    times, positions = circle(client.tool, radius, period)
    client.send(times, positions, max_time_scale=3.0)
    reported = 0.0
    while client.ending is None:
        rclpy.spin_once(client, timeout_sec=0.1)
        news = client.feedback
        if news is not None and news.elapsed >= reported:
            off = 1e3 * news.tracking_error
            print(f"{news.elapsed:6.1f} of {news.duration:g} s, {off:.1f} mm off the path")
            reported = news.elapsed + 0.1 * news.duration


def main(args: Sequence[str] | None = None) -> int:
    """Follow a circle; 0 where it succeeded."""
    parser = ArgumentParser(description="Send a circle of the end effector to the planner.")
    parser.add_argument("--frame", choices=sorted(FRAMES), default="map")
    parser.add_argument("--radius", type=float, default=0.2, help="m")
    parser.add_argument("--period", type=float, default=60.0, help="s")
    options = parser.parse_args(args)
    # rclpy's own handler would end the context on Ctrl-C, before the goal could be cancelled.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    client = PathClient(options.frame)
    try:
        try:
            follow(client, options.radius, options.period)
        except KeyboardInterrupt:
            client.cancel()
            while client.ending is None:
                rclpy.spin_once(client, timeout_sec=0.1)
    finally:
        rclpy.try_shutdown()
    print(f"{client.ending}: {client.message}")
    return 0 if client.ending == "succeeded" else 1


if __name__ == "__main__":
    raise SystemExit(main())
