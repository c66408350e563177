"""Frames of the arm in plain numpy: frame 0 is its base, frame i that of link i.

In link i-1 the joint's frame lies at its placement; it turns about its z, and the link's frame i
lies in it at the distal pose: T_(i-1)_i = placement Rz(theta) distal. With Denavit-Hartenberg
fields the placement is the identity, with an `origin` as in URDF the distal pose is.
"""

import math

import numpy as np

from uvms_core.rotations import quat_to_matrix, rpy_to_quat
from uvms_core.signals import Array
from uvms_core.vehicle.arm import Arm, Joint, Mounting
from uvms_core.vehicle.further_sensors import Sensor

Pose = tuple[Array, Array]
"""Origin (3,) and rotation matrix (3, 3) of one frame in another."""

IDENTITY: Pose = (np.zeros(3), np.eye(3))


def mounting_pose(mounting: Mounting | Sensor) -> Pose:
    """Pose of a mounted frame, from its position and roll, pitch, yaw."""
    return np.array(mounting.position_m), quat_to_matrix(rpy_to_quat(*np.radians(mounting.rpy_deg)))


def compose(first: Pose, second: Pose) -> Pose:
    """Pose of c in a from b in a and c in b: (p1 + R1 p2, R1 R2)."""
    return first[0] + first[1] @ second[0], first[1] @ second[1]


def placement_pose(joint: Joint) -> Pose:
    """The joint's frame at angle and offset zero in the previous link's: its `origin`."""
    return IDENTITY if joint.origin is None else mounting_pose(joint.origin)


def distal_pose(joint: Joint) -> Pose:
    """The link's frame in the joint's own, which turns with it: DH's Tz(d) Tx(a) Rx(alpha)."""
    if joint.a_m is None or joint.alpha_deg is None or joint.d_m is None:
        return IDENTITY
    c, s = math.cos(math.radians(joint.alpha_deg)), math.sin(math.radians(joint.alpha_deg))
    rotation = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return np.array([joint.a_m, 0.0, joint.d_m]), rotation


def joint_pose(joint: Joint, angle: float) -> Pose:
    """Frame i in the joint's placement: Rz(theta) Tz(d) Tx(a) Rx(alpha), before eq. (1)."""
    theta = angle + math.radians(joint.offset_deg)
    c, s = math.cos(theta), math.sin(theta)
    turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return compose((np.zeros(3), turn), distal_pose(joint))


def arm_frames(arm: Arm, q: Array) -> list[Pose]:
    """Frames 0..n of the arm in the body frame; q (n,) rad."""
    frames = [mounting_pose(arm.base)]
    for joint, angle in zip(arm.joints, q, strict=True):
        placed = compose(frames[-1], placement_pose(joint))
        frames.append(compose(placed, joint_pose(joint, angle)))
    return frames


def joint_frames(arm: Arm, q: Array) -> list[Pose]:
    """Frame of each joint in the body frame, z along its axis; q (n,) rad."""
    before = arm_frames(arm, q)[:-1]
    return [compose(f, placement_pose(j)) for f, j in zip(before, arm.joints, strict=True)]


def arm_length(arm: Arm) -> float:
    """Distances from joint to joint and on to the tool, m: the tool is never farther from joint 1.

    What a task for the arm is scaled by.
    """
    tool = compose(distal_pose(arm.joints[-1]), mounting_pose(arm.tool))
    pieces = [*joint_placements(arm)[1:], tool]
    return float(sum(np.linalg.norm(position) for position, _ in pieces))


def joint_placements(arm: Arm) -> list[Pose]:
    """Each joint's frame at angle and offset zero in the frame of the joint before it."""
    parents = [mounting_pose(arm.base), *(distal_pose(joint) for joint in arm.joints[:-1])]
    return [compose(p, placement_pose(j)) for p, j in zip(parents, arm.joints, strict=True)]
