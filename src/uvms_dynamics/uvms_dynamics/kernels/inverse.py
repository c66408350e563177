"""Recursive Newton-Euler: the forces that make a motion, and what the arm does to the vehicle."""

import numpy as np

from uvms_dynamics.kernels.chain import down_in_body, joint_rotations
from uvms_dynamics.kernels.drag import link_drag
from uvms_dynamics.kernels.hull import hull_bias
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.spatial import (
    accumulate,
    force_to_parent,
    gyroscopic,
    load,
    motion_to_child,
    store,
    times,
    turn_back,
    weight,
)
from uvms_dynamics.kernels.workspace import make_workspace


@kernel
def inverse_dynamics(model, quat, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Generalized force (6+n,) that makes a motion: body wrench, then joint torques.

    M(q) a + C nu + D nu less weight and buoyancy, of the hull and all links with added mass;
    without joint friction and limits. nu_r (6,) is relative to the water, body frame, nu_r_dot
    the derivative of its components; quat (4,); q, q_dot, q_ddot (n,). Eq. (2)-(7), (14)-(15).
    """
    n = q.shape[0]
    work = make_workspace(n)
    work.down[0, 0], work.down[0, 1], work.down[0, 2] = down_in_body(quat)
    out = np.empty(6 + n)
    forces_on_links(model, nu_r, nu_r_dot, q, q_dot, q_ddot, work)
    for i in range(n):
        out[6 + i] = work.force[i + 1, 5] + model.rotor_inertia[i] * q_ddot[i]
    _add_hull(model, nu_r, nu_r_dot, work)
    for k in range(6):
        out[k] = work.force[0, k]
    return out


@kernel
def coupling_wrench(model, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Wrench (6,) that the arm exerts ON the vehicle through joint 1, about the body origin.

    Inertia, added mass and drag of all links, without their weight and buoyancy, which eq. (13)
    counts. Eq. (14)-(15) with omega x (I omega), corrected from the print. Arguments as in
    `inverse_dynamics`; body frame.
    """
    work = make_workspace(q.shape[0])
    work.down[0, 0] = work.down[0, 1] = work.down[0, 2] = 0.0
    forces_on_links(model, nu_r, nu_r_dot, q, q_dot, q_ddot, work)
    out = np.empty(6)
    for k in range(6):
        out[k] = -work.force[0, k]
    return out


@kernel
def forces_on_links(model, nu_r, nu_r_dot, q, q_dot, q_ddot, work):
    """Outward motions, inward forces: work.force[i] through joint i, row 0 at the hull.

    work.down[0] gives the down direction in the body frame (zero leaves weight out).
    """
    n = q.shape[0]
    joint_rotations(model, q, work.rotation)
    for k in range(6):
        work.velocity[0, k] = nu_r[k]
        work.acceleration[0, k] = nu_r_dot[k]
        work.force[0, k] = 0.0
    for i in range(1, n + 1):
        _move_link(model, i, q_dot[i - 1], q_ddot[i - 1], work)
        _load_link(model, i, work)
    for i in range(n, 0, -1):
        f0, f1, f2, n0, n1, n2 = load(work.force, i)
        f0, f1, f2, n0, n1, n2 = force_to_parent(
            work.rotation, model.tree_position, i - 1, f0, f1, f2, n0, n1, n2
        )
        accumulate(work.force, i - 1, f0, f1, f2, n0, n1, n2)


@inner
def _move_link(model, i, rate, acceleration, work):
    """Velocity, acceleration and down direction of link i from those of its parent, eq. (2)-(7)."""
    frame, position = i - 1, model.tree_position
    v0, v1, v2, w0, w1, w2 = load(work.velocity, i - 1)
    v0, v1, v2, w0, w1, w2 = motion_to_child(work.rotation, position, frame, v0, v1, v2, w0, w1, w2)
    a0, a1, a2, b0, b1, b2 = load(work.acceleration, i - 1)
    a0, a1, a2, b0, b1, b2 = motion_to_child(work.rotation, position, frame, a0, a1, a2, b0, b1, b2)
    a0, a1, b0, b1 = a0 + rate * v1, a1 - rate * v0, b0 + rate * w1, b1 - rate * w0
    store(work.velocity, i, v0, v1, v2, w0, w1, w2 + rate)
    store(work.acceleration, i, a0, a1, a2, b0, b1, b2 + acceleration)
    k0, k1, k2 = work.down[i - 1, 0], work.down[i - 1, 1], work.down[i - 1, 2]
    k0, k1, k2 = turn_back(work.rotation, frame, k0, k1, k2)
    work.down[i, 0], work.down[i, 1], work.down[i, 2] = k0, k1, k2


@inner
def _load_link(model, i, work):
    """Force that link i needs for its own motion: I a + C v - drag - weight, eq. (14)."""
    v0, v1, v2, w0, w1, w2 = load(work.velocity, i)
    a0, a1, a2, b0, b1, b2 = load(work.acceleration, i)
    f0, f1, f2, n0, n1, n2 = times(model.inertia, i, a0, a1, a2, b0, b1, b2)
    g0, g1, g2, h0, h1, h2 = gyroscopic(model.inertia, i, v0, v1, v2, w0, w1, w2)
    d0, d1, d2, e0, e1, e2 = link_drag(model, i, v0, v1, v2, w0, w1, w2)
    s0, s1, s2, t0, t1, t2 = weight(model, i, work.down[i, 0], work.down[i, 1], work.down[i, 2])
    store(
        work.force,
        i,
        f0 + g0 - d0 - s0,
        f1 + g1 - d1 - s1,
        f2 + g2 - d2 - s2,
        n0 + h0 - e0 - t0,
        n1 + h1 - e1 - t1,
        n2 + h2 - e2 - t2,
    )


@inner
def _add_hull(model, nu_r, nu_r_dot, work):
    """Add what the hull itself needs to work.force[0]."""
    f0, f1, f2, n0, n1, n2 = times(
        model.inertia, 0, nu_r_dot[0], nu_r_dot[1], nu_r_dot[2],
        nu_r_dot[3], nu_r_dot[4], nu_r_dot[5],
    )  # fmt: skip
    accumulate(work.force, 0, f0, f1, f2, n0, n1, n2)
    f0, f1, f2, n0, n1, n2 = hull_bias(model, nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5])
    accumulate(work.force, 0, f0, f1, f2, n0, n1, n2)
    f0, f1, f2, n0, n1, n2 = weight(model, 0, work.down[0, 0], work.down[0, 1], work.down[0, 2])
    accumulate(work.force, 0, -f0, -f1, -f2, -n0, -n1, -n2)
