"""Friction and end stops of the joints."""

import math

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel


@kernel
def joint_passive_torque(model, q, q_dot):
    """Torque (n,) of friction and end stops ON each joint; q (n,) rad, q_dot (n,) rad/s.

    Friction -(b q_dot + c tanh(q_dot / w)) dissipates at every rate. Beyond a limit by d the
    stop pushes back with k d (1 + e d_dot), never pulling (Hunt and Crossley 1975).
    """
    out = np.empty(q.shape[0])
    for i in range(q.shape[0]):
        out[i] = passive_torque(model, i, q[i], q_dot[i])
    return out


@inner
def passive_torque(model, i, angle, rate):
    """The same of joint i alone."""
    viscous, coulomb, width = model.friction[i, 0], model.friction[i, 1], model.friction[i, 2]
    torque = -viscous * rate - coulomb * math.tanh(rate / width)
    low, high = model.stops[i, 0], model.stops[i, 1]
    if angle > high:
        torque -= _stop(model, i, angle - high, rate)
    elif angle < low:
        torque += _stop(model, i, low - angle, -rate)
    return torque


@inner
def _stop(model, i, depth, speed):
    """Push of an end stop pressed in by depth, rad, at a speed, rad/s."""
    return max(0.0, model.stops[i, 2] * depth * (1.0 + model.stops[i, 3] * speed))
