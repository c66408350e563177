"""The transforms of the vehicle's frames as tf2_msgs/TFMessage, in plain dicts.

Static ones join the marine frames to those of REP-103 and REP-105 (after the draft REP-156), so
that viewers show everything upright, and place what is fixed on vehicle and arm. Moving ones follow
odometry and joint states.
"""

import math
from typing import Any

import numpy as np

from uvms_core import topics
from uvms_core.description.tree import Branch, tree
from uvms_core.description.urdf import urdf_text
from uvms_core.messages import parts, to_message
from uvms_core.rotations import matrix_to_quat
from uvms_core.signals import JointStates, Odometry
from uvms_core.vehicle.frames import Pose
from uvms_core.vehicle.vehicle import Vehicle
from uvms_core.world_frames import MAP_FRAME, R_MAP_MAP_NED

Plain = dict[str, Any]


def description_message(vehicle: Vehicle) -> Plain:
    """std_msgs/String with the URDF."""
    return {"data": urdf_text(vehicle)}


def static_message(vehicle: Vehicle, stamp: int = 0) -> Plain:
    """Static transforms: map -> map_ned, and every fixed frame of the vehicle."""
    fixed = [branch for branch in tree(vehicle) if branch.joint is None]
    world = Branch(topics.WORLD_FRAME, MAP_FRAME, (np.zeros(3), R_MAP_MAP_NED))
    return {"transforms": [_transform(stamp, branch) for branch in (world, *fixed)]}


def _transform(stamp: int, branch: Branch) -> Plain:
    return {
        "header": {"stamp": parts.time(stamp), "frame_id": branch.parent},
        "child_frame_id": branch.frame,
        "transform": _pose(branch.pose),
    }


def _pose(pose: Pose) -> Plain:
    return {
        "translation": parts.vector(pose[0]),
        "rotation": parts.quaternion(matrix_to_quat(pose[1])),
    }


class StateFrames:
    """Moving transforms: map_ned -> base_link_fsd, and each link's frame in the previous one."""

    def __init__(self, vehicle: Vehicle) -> None:
        moving = [branch for branch in tree(vehicle) if branch.joint is not None]
        self._names = [(branch.parent, branch.frame) for branch in moving]
        self._origins = [parts.vector(branch.pose[0]) for branch in moving]
        self._turns = [tuple(matrix_to_quat(branch.pose[1]).tolist()) for branch in moving]

    def message(self, odometry: Odometry, joints: JointStates) -> Plain:
        """tf2_msgs/TFMessage at the odometry's stamp.

        A link's rotation is quat(R_fixed) * (0, 0, sin(q/2), cos(q/2)), in scalars, because this
        runs in every tick of the loop.
        """
        message = to_message(topics.TF, odometry)
        transforms = message["transforms"]
        stamp = transforms[0]["header"]["stamp"]
        for (parent, frame), origin, (x, y, z, w), angle in zip(
            self._names, self._origins, self._turns, joints.position.tolist(), strict=True
        ):
            c, s = math.cos(0.5 * angle), math.sin(0.5 * angle)
            turn = {"x": x * c + y * s, "y": y * c - x * s, "z": w * s + z * c, "w": w * c - z * s}
            transforms.append(
                {
                    "header": {"stamp": stamp, "frame_id": parent},
                    "child_frame_id": frame,
                    "transform": {"translation": origin, "rotation": turn},
                }
            )
        return message
