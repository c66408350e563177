"""Send a path of the end effector to a running vehicle, report how it goes, cancel it on Ctrl-C.

Start a vehicle first: uvms run manipulation --pace realtime --set goal={}. In another terminal:
python examples/clients/path_client.py --frame map --radius 0.2 --period 60
"""

from argparse import ArgumentParser
from collections.abc import Sequence
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from goal_client import FRAMES, Array, GoalClient, carry_out, duration
from rclpy.qos import qos_profile_sensor_data

from uvms_msgs.action import FollowEndEffectorPath
from uvms_msgs.msg import Reference

POINTS_A_TURN = 120
SLOWEST = 3.0
"""How many times as long the path may take where it is too fast."""


def circle(start: Array, radius: float, period: float) -> tuple[Array, Array]:
    """Times (k,) and positions (k, 3) of a horizontal circle through `start`, from rest to rest.

    The angle goes as 2 pi (10 u^3 - 15 u^4 + 6 u^5), so that speed and acceleration vanish at both
    ends.
    """
    u = np.linspace(0.0, 1.0, POINTS_A_TURN + 1)
    angle = 2 * np.pi * u**3 * (10 - 15 * u + 6 * u**2)
    offsets = np.column_stack([1 - np.cos(angle), np.sin(angle), 0 * angle])
    return period * u, start + radius * offsets


class PathClient(GoalClient):
    """Client of the action `follow_end_effector_path`, with all positions in `frame`."""

    def __init__(self, frame: str, **options: Any) -> None:
        kind = FollowEndEffectorPath
        super().__init__("path_client", kind, "follow_end_effector_path", frame, **options)
        self.tool: Array | None = None  # (3,) m, where the planner has the tool, in `frame`
        self.create_subscription(
            Reference, "reference", self._take_reference, qos_profile_sensor_data
        )

    @property
    def located(self) -> bool:
        """Whether the planner has said where the tool is."""
        return self.tool is not None

    def send(self, times: Array, positions: Array, max_time_scale: float = 1.0) -> None:
        """Ask for a path through `positions` (k, 3) in `frame` at `times` (k,) s, from 0."""
        goal = FollowEndEffectorPath.Goal()
        goal.time_from_start = [duration(time) for time in times.tolist()]
        goal.positions = [Point(x=x, y=y, z=z) for x, y, z in positions.tolist()]
        goal.max_time_scale = max_time_scale
        self.ask(goal)

    def _take_reference(self, msg: Reference) -> None:
        point = msg.points[-1].end_effector
        self.tool = FRAMES[self.frame] @ np.array([point.x, point.y, point.z])


def main(args: Sequence[str] | None = None) -> int:
    """Follow a circle; 0 where it succeeded."""
    parser = ArgumentParser(description="Send a circle of the end effector to the planner.")
    parser.add_argument("--frame", choices=sorted(FRAMES), default="map")
    parser.add_argument("--radius", type=float, default=0.2, help="m")
    parser.add_argument("--period", type=float, default=60.0, help="s")
    options = parser.parse_args(args)

    def send(client: PathClient) -> None:
        client.send(*circle(client.tool, options.radius, options.period), max_time_scale=SLOWEST)

    return carry_out(
        lambda: PathClient(options.frame),
        send,
        lambda news: f"{1e3 * news.tracking_error:.1f} mm off the path",
    )


if __name__ == "__main__":
    raise SystemExit(main())
