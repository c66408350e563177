"""Recursive Newton-Euler: the forces that make a motion, and what the arm does to the vehicle."""

import numpy as np

from uvms_dynamics.kernels.forward import set_hull
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    ACCELERATION,
    DOWN,
    FORCE,
    HULL,
    INERTIA,
    LINEAR_PART,
    RATE,
    ROTOR,
)
from uvms_dynamics.kernels.motion import (
    carry_down,
    carry_velocity,
    down_in_body,
    hull_bias_force,
    link_bias_force,
    make_workspace,
    set_angle,
    to_body,
    to_hull,
)
from uvms_dynamics.kernels.spatial import (
    add,
    force_to_parent,
    load,
    load3,
    motion_to_child,
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
    work, out = make_workspace(n), np.empty(6 + n)
    _set_motion(model, work, down_in_body(quat[0], quat[1], quat[2], quat[3]), nu_r, nu_r_dot)
    _forces_of_links(model, work, q, q_dot, q_ddot)
    store(work, HULL, FORCE, *hull_bias_force(model, work))
    _add_inertia_force(model, work, HULL)
    _carry_inward(model, work, n)
    _store_wrench(model, work, 1.0, out)
    for i in range(1, n + 1):
        out[5 + i] = work[i, FORCE + 5] + model[i, ROTOR] * q_ddot[i - 1]
    return out


@kernel
def coupling_wrench(model, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Wrench (6,) that the arm exerts ON the vehicle through joint 1, about the body origin.

    Inertia, added mass and drag of all links, without their weight and buoyancy, which eq. (13)
    counts. Eq. (14)-(15) with omega x (I omega), corrected from the print. Arguments as in
    `inverse_dynamics`; body frame.
    """
    n = q.shape[0]
    work, out = make_workspace(n), np.empty(6)
    _set_motion(model, work, (0.0, 0.0, 0.0), nu_r, nu_r_dot)  # no down, no weight
    _forces_of_links(model, work, q, q_dot, q_ddot)
    store(work, HULL, FORCE, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    _carry_inward(model, work, n)
    _store_wrench(model, work, -1.0, out)
    return out


@inner
def _set_motion(model, work, down, nu_r, nu_r_dot):
    """Down direction, velocity and acceleration of the hull."""
    set_hull(model, work, down, nu_r, LINEAR_PART)
    store3(work, HULL, ACCELERATION, *to_hull(model, nu_r_dot[0], nu_r_dot[1], nu_r_dot[2]))
    store3(work, HULL, ACCELERATION + 3, *to_hull(model, nu_r_dot[3], nu_r_dot[4], nu_r_dot[5]))


@inner
def _forces_of_links(model, work, q, q_dot, q_ddot):
    """Motion of each link and the force that it needs for it, I a + C v - drag - weight."""
    for i in range(1, q.shape[0] + 1):
        set_angle(model, work, i, q[i - 1])
        work[i, RATE] = q_dot[i - 1]
        x0, x1, y0, y1 = carry_velocity(model, work, i)
        a0, a1, a2, b0, b1, b2 = load(work, i - 1, ACCELERATION)
        a0, a1, a2, b0, b1, b2 = motion_to_child(model, work, i, a0, a1, a2, b0, b1, b2)
        b2 += q_ddot[i - 1]
        store(work, i, ACCELERATION, a0 + x0, a1 + x1, a2, b0 + y0, b1 + y1, b2)
        carry_down(model, work, i)
        store(work, i, FORCE, *link_bias_force(model, work, i))
        _add_inertia_force(model, work, i)


@inner
def _add_inertia_force(model, work, i):
    """Add I a of body i to its force."""
    a0, a1, a2, b0, b1, b2 = load(work, i, ACCELERATION)
    add(work, i, FORCE, *times(model, i, INERTIA, a0, a1, a2, b0, b1, b2))


@inner
def _carry_inward(model, work, n):
    """Sum the forces from the tip to the hull, eq. (14)-(15); row i: through joint i."""
    for i in range(n, 0, -1):
        f0, f1, f2, n0, n1, n2 = load(work, i, FORCE)
        add(work, i - 1, FORCE, *force_to_parent(model, work, i, f0, f1, f2, n0, n1, n2))


@inner
def _store_wrench(model, work, sign, out):
    """Force on the hull, in body axes, times a sign."""
    f0, f1, f2 = to_body(model, *load3(work, HULL, FORCE))
    n0, n1, n2 = to_body(model, *load3(work, HULL, FORCE + 3))
    out[0], out[1], out[2] = sign * f0, sign * f1, sign * f2
    out[3], out[4], out[5] = sign * n0, sign * n1, sign * n2
