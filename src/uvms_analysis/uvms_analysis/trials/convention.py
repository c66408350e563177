"""From the trials' convention to ours and back.

Trials: body forward-left-up, world z up, pitch positive nose down. Ours: body forward-starboard-
down, world z down (NED up to a heading). Both differ by F = diag(1, -1, -1) on either side, so
roll stays, pitch and yaw change their signs.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.rotations import rpy_to_quat

FLIP = np.array([1.0, -1.0, -1.0])
"""Components of a vector from one convention to the other, either way."""

SURFACE_Z_M = 1.29
"""Height of the vehicle at the surface in the trials' world (README of the data)."""

JOINTS = ("base", "shoulder", "elbow", "wrist")
"""The arm's joints, whose angles are the columns q_e, q_d, q_c, q_b."""

JOINT_ZERO_RAD = np.array([3.07, 0.0, 0.0, 2.879])
"""Measured axes e, d, c, b at joint angle zero of base, shoulder, elbow and wrist."""


def joint_angles(alpha: Array) -> Array:
    """Joint angles (k, 4), rad, from the measured axes e, d, c, b."""
    return np.asarray(alpha - JOINT_ZERO_RAD)


def position_down(position: Array) -> Array:
    """Position (.., 3) with z the depth below the surface."""
    return np.asarray((position - np.array([0.0, 0.0, SURFACE_Z_M])) * FLIP)


def quaternion(attitude_deg: Array) -> Array:
    """Our attitude (4,) from the trials' roll, pitch, yaw (3,) in degrees."""
    return rpy_to_quat(*(np.radians(attitude_deg) * FLIP))


def tilt_deg(down: Array) -> Array:
    """The trials' roll and pitch (.., 2), degrees, from the down direction (.., 3) in our body."""
    x, y, z = np.moveaxis(np.asarray(down), -1, 0)
    return np.degrees(np.stack([np.arctan2(y, z), np.arcsin(np.clip(x, -1.0, 1.0))], axis=-1))


def down_direction(tilt: Array) -> Array:
    """The down direction (3,) in our body from the trials' roll and pitch (2,), degrees."""
    roll, pitch = np.radians(tilt)
    return np.array([np.sin(pitch), np.sin(roll) * np.cos(pitch), np.cos(roll) * np.cos(pitch)])
