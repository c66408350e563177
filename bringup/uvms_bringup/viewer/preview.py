"""What the planner would make of a goal, before anybody sends it."""

from dataclasses import dataclass, replace

import numpy as np

from uvms_bringup.viewer.moment import Posture, tool_pose
from uvms_core.rotations import matrix_to_quat
from uvms_core.signals import (
    Array,
    JointStates,
    Odometry,
    PathGoal,
    to_nanoseconds,
)
from uvms_core.vehicle.frames import Pose
from uvms_core.vehicle.vehicle import Vehicle
from uvms_planner.config import PlannerConfig
from uvms_planner.errors import GoalRejected
from uvms_planner.planner import MotionPlanner

SLOWEST = 20.0
"""A goal may take so many times as long where the limits ask for it."""
SHORTEST_S = 2.0
"""Of a motion, however near its end is."""
LONGEST_S = 600.0
"""Of a preview: farther ahead nobody looks."""


@dataclass(frozen=True)
class Preview:
    """A motion as planned, or why there is none."""

    tool: Array  # (k, 3) m, map_ned
    end: Posture | None
    seconds: float
    refusal: str = ""


def straight_goal(start: Pose, end: Pose, speed: float, turns: bool = False) -> PathGoal:
    """The tool from rest to rest along a line, at a mean speed in m/s.

    Args:
        start: pose of the tool in map_ned.
        end: where it is to go.
        speed: m/s.
        turns: it is to have the end's rotation there; else it turns as it likes.
    """
    seconds = max(float(np.linalg.norm(end[0] - start[0])) / speed, SHORTEST_S)
    turned = [matrix_to_quat(R) for _, R in (start, end)] if turns else np.empty((0, 4))
    return PathGoal(
        np.array([0.0, seconds]),
        np.array([start[0], end[0]]),
        np.array(turned),
        time_scale_max=SLOWEST,
    )


def preview(
    vehicle: Vehicle, config: PlannerConfig, odometry: Odometry, joints: JointStates, goal: PathGoal
) -> Preview:
    """Plan a goal here, from rest in the present pose, by the planner that the graph has.

    The planner of the graph may know more: what the gripper holds and which thrusters are weak.
    """
    planner, stamp = MotionPlanner(vehicle, config, 0), odometry.stamp
    step = to_nanoseconds(config.step_s)
    joints = replace(joints, stamp=stamp)
    references = list(planner.step(stamp, odometry, joints).references)
    try:
        planner.accept(goal)
    except GoalRejected as fault:
        return Preview(np.empty((0, 3)), None, 0.0, str(fault))
    for _ in range(int(LONGEST_S / config.step_s)):
        if not planner.has_goal:
            break
        stamp += step
        there = replace(odometry, stamp=stamp), replace(joints, stamp=stamp)
        references += planner.step(stamp, *there).references
    tool = np.concatenate([each.end_effector for each in references])
    last = references[-1]
    end = Posture(last.position[-1], last.quaternion[-1], last.q[-1])
    return Preview(tool, end, (last.end - odometry.stamp) / 1e9)


def tool_now(vehicle: Vehicle, odometry: Odometry, joints: JointStates) -> Pose:
    """The tool in map_ned."""
    posture = Posture(odometry.position, odometry.quaternion, joints.position)
    return tool_pose(vehicle, posture)
