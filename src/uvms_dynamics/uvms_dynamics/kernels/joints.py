"""Friction and end stops of the joints."""

import numpy as np

from uvms_dynamics.kernels.arithmetic import hyperbolic_tangent
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    COULOMB,
    DISSIPATION,
    INVERSE_WIDTH,
    LOWER,
    STIFFNESS,
    UPPER,
    VISCOUS,
)
from uvms_dynamics.kernels.motion import check_joints
from uvms_dynamics.kernels.numba_internals.primitives import maximum


@kernel
def joint_passive_torque(model, q, q_dot):
    """Torque (n,) of friction and end stops ON each joint; q (n,) rad, q_dot (n,) rad/s.

    Friction -(b q_dot + c tanh(q_dot / w)) dissipates at every rate. Beyond a limit by d the
    stop pushes back with k d (1 + e d_dot), never pulling (Hunt and Crossley 1975).
    """
    check_joints(model, q, q_dot, q_dot)
    out = np.empty(q.shape[0])
    for i in range(q.shape[0]):
        out[i] = passive_torque(model, i + 1, q[i], q_dot[i])
    return out


@inner
def passive_torque(model, i, angle, rate):
    """The same of the joint in row i."""
    friction = model[i, VISCOUS] * rate
    friction += model[i, COULOMB] * hyperbolic_tangent(rate * model[i, INVERSE_WIDTH])
    over, under = angle - model[i, UPPER], model[i, LOWER] - angle
    return _stop(model, i, under, -rate) - _stop(model, i, over, rate) - friction


@inner
def _stop(model, i, depth, speed):
    """Push of an end stop pressed in by depth, rad, at a speed, rad/s; none where depth < 0."""
    push = model[i, STIFFNESS] * maximum(depth, 0.0)
    return push * maximum(1.0 + model[i, DISSIPATION] * speed, 0.0)
