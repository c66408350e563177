"""Kinematics of vehicle and arm in plain numpy, eq. (1), (10)-(12), to compare kernels with."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.arm import Arm
from uvms_core.vehicle.frames import Pose, arm_frames, compose, joint_frames, mounting_pose
from uvms_dynamics.kernels.rotations import quat_to_matrix


def end_effector(arm: Arm, position: Array, quaternion: Array, q: Array) -> Pose:
    """Tool pose in the world: T_world_body T_body_0 prod T_(i-1)_i T_tool, eq. (1).

    Corrected from the print, whose leading symbols are garbled.
    """
    vehicle = (np.asarray(position), quat_to_matrix(quaternion))
    tool = compose(arm_frames(arm, q)[-1], mounting_pose(arm.tool))
    return compose(vehicle, tool)


def end_effector_jacobian(arm: Arm, quaternion: Array, q: Array) -> Array:
    """J (6, 6+n) from (nu, q_dot), nu in the body frame, to the tool's (v, omega) in the world.

    Eq. (10)-(12), J_v = [E, -[r_n - r_v]x; 0, E] and column i of J_m =
    [z_(i-1) x (r_n - r_(i-1)); z_(i-1)], corrected from the print (the skew symbol is missing in
    J_v, the indices of J_m are shifted).
    """
    tool = compose(arm_frames(arm, q)[-1], mounting_pose(arm.tool))[0]
    columns = [np.concatenate([axis, np.zeros(3)]) for axis in np.eye(3)]
    columns += [np.concatenate([np.cross(axis, tool), axis]) for axis in np.eye(3)]
    for origin, rotation in joint_frames(arm, q):
        z = rotation[:, 2]
        columns.append(np.concatenate([np.cross(z, tool - origin), z]))
    to_world = np.kron(np.eye(2), quat_to_matrix(quaternion))
    return to_world @ np.array(columns).T
