"""Send a running vehicle to a pose, report how it goes, cancel it on Ctrl-C.

Start a vehicle first: uvms run hover --pace realtime. In another terminal:
python examples/pose_client/pose_client.py --frame map --move 2 0 0 --turn 30
"""

import math
from argparse import ArgumentParser
from collections.abc import Sequence
from typing import Any

import numpy as np
import rclpy
from action_msgs.msg import GoalStatus
from builtin_interfaces.msg import Duration
from geometry_msgs.msg import Point, Quaternion
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from rclpy.action import ActionClient
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from rclpy.signals import SignalHandlerOptions
from rclpy.task import Future

from uvms_msgs.action import GoToPose

Array = NDArray[np.float64]
FRAMES = {"map_ned": np.eye(3), "map": np.array([[0.0, 1, 0], [1, 0, 0], [0, 0, -1]])}
"""Components in map_ned (north, east, down) to those in each frame; map is east, north, up."""
ENDINGS = {
    GoalStatus.STATUS_SUCCEEDED: "succeeded",
    GoalStatus.STATUS_CANCELED: "cancelled",
    GoalStatus.STATUS_ABORTED: "aborted",
}


class PoseClient(Node):
    """Client of the action `go_to_pose`, with all poses in `frame`.

    In `map` a pose is that of base_link (forward, port, up), with its yaw from east to the north;
    in `map_ned` of base_link_fsd (forward, starboard, down), with its yaw from north to the east.
    """

    def __init__(self, frame: str, **options: Any) -> None:
        super().__init__("pose_client", **options)
        self.frame = frame
        self.position: Array | None = None  # (3,) m, of the estimated vehicle, in `frame`
        self.yaw = 0.0  # rad, likewise
        self.feedback: Any = None
        self.ending: str | None = None  # how the goal ended; "rejected" where it never began
        self.message = ""
        self._handle: Any = None
        self._cancelled = False
        self._client = ActionClient(self, GoToPose, "go_to_pose")
        self.create_subscription(Odometry, "odometry", self._take_odometry, qos_profile_sensor_data)

    @property
    def ready(self) -> bool:
        """Whether the planner is there, and it is known where the vehicle is."""
        return self.position is not None and self._client.server_is_ready()

    def send(
        self,
        position: Array,
        yaw: float,
        duration: float = 0.0,
        hold: float = 0.0,
        max_speed: float = 0.0,
    ) -> None:
        """Ask for a pose: position (3,) m and yaw in rad, in `frame`; times in s, 0 for none."""
        goal = GoToPose.Goal()
        goal.header.frame_id = self.frame
        x, y, z = np.asarray(position, dtype=float).tolist()
        goal.pose.position = Point(x=x, y=y, z=z)
        goal.pose.orientation = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
        goal.duration, goal.hold = _duration(duration), _duration(hold)
        goal.max_speed = max_speed
        asked = self._client.send_goal_async(goal, self._take_feedback)
        asked.add_done_callback(self._take_answer)

    def cancel(self) -> None:
        """Ask the planner to come to rest, now or as soon as it has accepted the goal."""
        self._cancelled = True
        if self._handle is not None:
            self._handle.cancel_goal_async()

    def _take_odometry(self, msg: Odometry) -> None:
        at, turned = msg.pose.pose.position, msg.pose.pose.orientation
        x, y, z, w = turned.x, turned.y, turned.z, turned.w
        heading = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        self.position = FRAMES[self.frame] @ np.array([at.x, at.y, at.z])
        self.yaw = math.pi / 2 - heading if self.frame == "map" else heading

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


def go(client: PoseClient, move: Array, turn: float, **more: float) -> None:
    """Send the pose that lies `move` (3,) m and `turn` rad from here; print until it has ended."""
    while not client.ready:
        rclpy.spin_once(client, timeout_sec=0.1)
    client.send(client.position + move, client.yaw + turn, **more)
    reported = 0.0
    while client.ending is None:
        rclpy.spin_once(client, timeout_sec=0.1)
        news = client.feedback
        if news is not None and news.elapsed >= reported:
            print(f"{news.elapsed:6.1f} of {news.duration:.1f} s, {news.distance:.2f} m to go")
            reported = news.elapsed + 0.1 * news.duration


def main(args: Sequence[str] | None = None) -> int:
    """Go to a pose; 0 where it succeeded."""
    parser = ArgumentParser(description="Send the vehicle to a pose, from where it is now.")
    parser.add_argument("--frame", choices=sorted(FRAMES), default="map")
    parser.add_argument("--move", type=float, nargs=3, default=[0.0, 0.0, 0.0], help="m")
    parser.add_argument("--turn", type=float, default=0.0, help="deg, in the frame")
    parser.add_argument("--duration", type=float, default=0.0, help="s; 0: as short as possible")
    parser.add_argument("--hold", type=float, default=0.0, help="s, to stay there")
    parser.add_argument("--max-speed", type=float, default=0.0, help="m/s; 0: no bound")
    options = parser.parse_args(args)
    # rclpy's own handler would end the context on Ctrl-C, before the goal could be cancelled.
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    client = PoseClient(options.frame)
    more = {"duration": options.duration, "hold": options.hold, "max_speed": options.max_speed}
    try:
        try:
            go(client, np.array(options.move), math.radians(options.turn), **more)
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
