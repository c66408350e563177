"""Recursive Newton-Euler: the forces that make a motion, and what the arm does to the vehicle."""

import numpy as np

from uvms_dynamics.kernels.hull import damping
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import ACCELERATION, DOWN, FORCE, HULL, ROTOR, VELOCITY
from uvms_dynamics.kernels.motion import (
    bias_force,
    carry_down,
    carry_velocity,
    down_in_body,
    make_workspace,
    resist,
)
from uvms_dynamics.kernels.spatial import (
    add,
    force_to_parent,
    load,
    motion_to_child,
    set_rotation,
    store,
    store3,
    times,
)


@kernel
def inverse_dynamics(model, quat, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Generalized force (6+n,) that makes a motion: body wrench, then joint torques.

    M(q) a + C nu + D nu less weight and buoyancy, of the hull and all links with added mass;
    without joint friction and limits. nu_r (6,) is relative to the water, body frame, nu_r_dot
    the derivative of its components; quat (4,); q, q_dot, q_ddot (n,). Eq. (2)-(7), (14)-(15).
    """
    n = q.shape[0]
    work = make_workspace(n)
    k0, k1, k2 = down_in_body(quat[0], quat[1], quat[2], quat[3])
    store3(work, HULL, DOWN, k0, k1, k2)
    forces_of_links(model, nu_r, nu_r_dot, q, q_dot, q_ddot, work)
    bias_force(model.bodies, work, HULL)
    _inertia_force(model.bodies, work, HULL)
    _carry_inward(model.joints, work, n)
    out = np.empty(6 + n)
    for i in range(1, n + 1):
        out[5 + i] = work[i, FORCE + 5] + model.joints[i, ROTOR] * q_ddot[i - 1]
    for k in range(6):
        out[k] = work[0, FORCE + k] + damping(model.hull, k, nu_r[k])
    return out


@kernel
def coupling_wrench(model, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Wrench (6,) that the arm exerts ON the vehicle through joint 1, about the body origin.

    Inertia, added mass and drag of all links, without their weight and buoyancy, which eq. (13)
    counts. Eq. (14)-(15) with omega x (I omega), corrected from the print. Arguments as in
    `inverse_dynamics`; body frame.
    """
    n = q.shape[0]
    work = make_workspace(n)
    store3(work, HULL, DOWN, 0.0, 0.0, 0.0)  # no down, no weight
    forces_of_links(model, nu_r, nu_r_dot, q, q_dot, q_ddot, work)
    store(work, HULL, FORCE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    _carry_inward(model.joints, work, n)
    out = np.empty(6)
    for k in range(6):
        out[k] = -work[0, FORCE + k]
    return out


@inner
def forces_of_links(model, nu_r, nu_r_dot, q, q_dot, q_ddot, work):
    """Motion of each link and the force that it needs for it, I a + C v - drag - weight."""
    bodies, joints = model.bodies, model.joints
    for k in range(6):
        work[0, VELOCITY + k] = nu_r[k]
        work[0, ACCELERATION + k] = nu_r_dot[k]
    for i in range(1, q.shape[0] + 1):
        set_rotation(joints, work, i, q[i - 1])
        carry_down(work, i)
        x0, x1, y0, y1 = carry_velocity(joints, work, i, q_dot[i - 1])
        a0, a1, a2, b0, b1, b2 = load(work, i - 1, ACCELERATION)
        a0, a1, a2, b0, b1, b2 = motion_to_child(joints, work, i, a0, a1, a2, b0, b1, b2)
        b2 += q_ddot[i - 1]
        store(work, i, ACCELERATION, a0 + x0, a1 + x1, a2, b0 + y0, b1 + y1, b2)
        bias_force(bodies, work, i)
        _inertia_force(bodies, work, i)
        resist(model.strips, model.strip_start, model.drag_coefficient, work, i)


@inner
def _inertia_force(bodies, work, i):
    """Add I a of body i to its force."""
    a0, a1, a2, b0, b1, b2 = load(work, i, ACCELERATION)
    f0, f1, f2, n0, n1, n2 = times(bodies, i, a0, a1, a2, b0, b1, b2)
    add(work, i, FORCE, f0, f1, f2, n0, n1, n2)


@inner
def _carry_inward(joints, work, n):
    """Sum the forces from the tip to the hull, eq. (14)-(15); row i: through joint i."""
    for i in range(n, 0, -1):
        f0, f1, f2, n0, n1, n2 = load(work, i, FORCE)
        f0, f1, f2, n0, n1, n2 = force_to_parent(joints, work, i, f0, f1, f2, n0, n1, n2)
        add(work, i - 1, FORCE, f0, f1, f2, n0, n1, n2)
