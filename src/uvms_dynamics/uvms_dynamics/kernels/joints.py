"""Friction and end stops of the joints."""

import math

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    COULOMB,
    DISSIPATION,
    LOWER,
    STIFFNESS,
    UPPER,
    VISCOUS,
    WIDTH,
)


@kernel
def joint_passive_torque(model, q, q_dot):
    """Torque (n,) of friction and end stops ON each joint; q (n,) rad, q_dot (n,) rad/s.

    Friction -(b q_dot + c tanh(q_dot / w)) dissipates at every rate. Beyond a limit by d the
    stop pushes back with k d (1 + e d_dot), never pulling (Hunt and Crossley 1975).
    """
    out = np.empty(q.shape[0])
    for i in range(q.shape[0]):
        out[i] = passive_torque(model.joints, i + 1, q[i], q_dot[i])
    return out


@inner
def passive_torque(joints, i, angle, rate):
    """The same of the joint in row i."""
    torque = -joints[i, VISCOUS] * rate - joints[i, COULOMB] * math.tanh(rate / joints[i, WIDTH])
    over, under = angle - joints[i, UPPER], joints[i, LOWER] - angle
    if over > 0.0:
        torque -= _stop(joints, i, over, rate)
    elif under > 0.0:
        torque += _stop(joints, i, under, -rate)
    return torque


@inner
def _stop(joints, i, depth, speed):
    """Push of an end stop pressed in by depth, rad, at a speed, rad/s."""
    return max(0.0, joints[i, STIFFNESS] * depth * (1.0 + joints[i, DISSIPATION] * speed))
