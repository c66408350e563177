"""Send a running vehicle to a pose, report how it goes, cancel it on Ctrl-C.

Start a vehicle first: uvms run hover --pace realtime. In another terminal:
python examples/clients/pose_client.py --frame map --move 2 0 0 --turn 30
"""

import math
from argparse import ArgumentParser
from collections.abc import Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Quaternion
from goal_client import FRAMES, Array, GoalClient, carry_out, duration
from nav_msgs.msg import Odometry
from rclpy.qos import qos_profile_sensor_data

from uvms_msgs.action import GoToPose


class PoseClient(GoalClient):
    """Client of the action `go_to_pose`, with all poses in `frame`.

    In `map` a pose is that of base_link (forward, port, up), with its yaw from east to the north;
    in `map_ned` of base_link_fsd (forward, starboard, down), with its yaw from north to the east.
    """

    def __init__(self, frame: str, **options: Any) -> None:
        super().__init__("pose_client", GoToPose, "go_to_pose", frame, **options)
        self.position: Array | None = None  # (3,) m, of the estimated vehicle, in `frame`
        self.yaw = 0.0  # rad, likewise
        self.create_subscription(Odometry, "odometry", self._take_odometry, qos_profile_sensor_data)

    @property
    def located(self) -> bool:
        """Whether it is known where the vehicle is."""
        return self.position is not None

    def send(
        self,
        position: Array,
        yaw: float,
        way_s: float = 0.0,
        hold: float = 0.0,
        max_speed: float = 0.0,
    ) -> None:
        """Ask for a pose: position (3,) m and yaw in rad, in `frame`; times in s, 0 for none."""
        goal = GoToPose.Goal()
        x, y, z = np.asarray(position, dtype=float).tolist()
        goal.pose.position = Point(x=x, y=y, z=z)
        goal.pose.orientation = Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
        goal.duration, goal.hold = duration(way_s), duration(hold)
        goal.max_speed = max_speed
        self.ask(goal)

    def _take_odometry(self, msg: Odometry) -> None:
        at, turned = msg.pose.pose.position, msg.pose.pose.orientation
        x, y, z, w = turned.x, turned.y, turned.z, turned.w
        heading = math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))
        self.position = FRAMES[self.frame] @ np.array([at.x, at.y, at.z])
        self.yaw = math.pi / 2 - heading if self.frame == "map" else heading


def main(args: Sequence[str] | None = None) -> int:
    """Go to the pose that lies so far from here; 0 where it succeeded."""
    parser = ArgumentParser(description="Send the vehicle to a pose, from where it is now.")
    parser.add_argument("--frame", choices=sorted(FRAMES), default="map")
    parser.add_argument("--move", type=float, nargs=3, default=[0.0, 0.0, 0.0], help="m")
    parser.add_argument("--turn", type=float, default=0.0, help="deg, in the frame")
    parser.add_argument("--duration", type=float, default=0.0, help="s; 0: as short as possible")
    parser.add_argument("--hold", type=float, default=0.0, help="s, to stay there")
    parser.add_argument("--max-speed", type=float, default=0.0, help="m/s; 0: no bound")
    options = parser.parse_args(args)

    def send(client: PoseClient) -> None:
        position, yaw = client.position + np.array(options.move), math.radians(options.turn)
        client.send(position, client.yaw + yaw, options.duration, options.hold, options.max_speed)

    return carry_out(
        lambda: PoseClient(options.frame), send, lambda news: f"{news.distance:.2f} m to go"
    )


if __name__ == "__main__":
    raise SystemExit(main())
