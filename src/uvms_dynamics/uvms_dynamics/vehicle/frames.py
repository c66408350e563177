"""Frames of the arm in plain numpy: frame 0 is its base, frame i the distal DH frame of link i."""

import math

import numpy as np

from uvms_dynamics.rotations import quat_to_matrix, rpy_to_quat
from uvms_dynamics.signals import Array
from uvms_dynamics.vehicle.arm import Arm, Joint, Mounting

Pose = tuple[Array, Array]
"""Origin (3,) and rotation matrix (3, 3) of one frame in another."""


def mounting_pose(mounting: Mounting) -> Pose:
    """Pose of a mounted frame, from its position and roll, pitch, yaw."""
    return np.array(mounting.position_m), quat_to_matrix(rpy_to_quat(*np.radians(mounting.rpy_deg)))


def compose(first: Pose, second: Pose) -> Pose:
    """Pose of c in a from b in a and c in b: (p1 + R1 p2, R1 R2)."""
    return first[0] + first[1] @ second[0], first[1] @ second[1]


def joint_pose(joint: Joint, angle: float) -> Pose:
    """Pose of frame i in frame i-1: Rz(theta) Tz(d) Tx(a) Rx(alpha), the matrix before eq. (1)."""
    theta = angle + math.radians(joint.offset_deg)
    c, s = math.cos(theta), math.sin(theta)
    ca, sa = math.cos(math.radians(joint.alpha_deg)), math.sin(math.radians(joint.alpha_deg))
    rotation = np.array([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0.0, sa, ca]])
    return np.array([joint.a_m * c, joint.a_m * s, joint.d_m]), rotation


def arm_frames(arm: Arm, q: Array) -> list[Pose]:
    """Frames 0..n of the arm in the body frame; q (n,) rad."""
    frames = [mounting_pose(arm.base)]
    for joint, angle in zip(arm.joints, q, strict=True):
        frames.append(compose(frames[-1], joint_pose(joint, angle)))
    return frames
