"""Recursive Newton-Euler: the forces that make a motion, and what the arm does to the vehicle."""

import numpy as np

from uvms_dynamics.kernels.drag import apply_drag
from uvms_dynamics.kernels.inertia import load_inertia
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import FIRST, FORCE, HULL, INERTIA, ROTOR
from uvms_dynamics.kernels.motion import (
    check_joints,
    check_motion,
    check_quaternion,
    down_in_body,
    hull_bias_force,
    into_body,
    into_hull,
    link_velocity,
    make_workspace,
    set_angle,
    set_link_force,
    to_hull,
    velocity_product,
)
from uvms_dynamics.kernels.spatial import (
    force_to_parent,
    load6,
    motion_to_child,
    plus,
    spatial_at,
    store_spatial,
    times,
    to_child,
)


@kernel
def inverse_dynamics(model, quat, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """Generalized force (6+n,) that makes a motion: body wrench, then joint torques.

    M(q) a + C nu + D nu less weight and buoyancy, of the hull and all links with added mass;
    without joint friction and limits. nu_r (6,) is relative to the water, body frame, nu_r_dot
    the derivative of its components; quat (4,) unit; q, q_dot, q_ddot (n,). Eq. (2)-(7), (14)-(15).
    """
    check_quaternion(quat)
    check_motion(nu_r, nu_r_dot)
    check_joints(model, q, q_dot, q_ddot)
    n = q.shape[0]
    work, out = make_workspace(model), np.empty(6 + n)
    down = to_hull(model, down_in_body(quat[0], quat[1], quat[2], quat[3]))
    v, a = into_hull(model, spatial_at(nu_r, FIRST)), into_hull(model, spatial_at(nu_r_dot, FIRST))
    _forces_of_links(model, work, down, v, a, q, q_dot, q_ddot)
    force = plus(hull_bias_force(model, v, down), times(load_inertia(model, HULL, INERTIA), a))
    force = into_body(model, plus(force, _carry_inward(model, work, n)))
    for k in range(6):
        out[k] = force[k]
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
    check_motion(nu_r, nu_r_dot)
    check_joints(model, q, q_dot, q_ddot)
    n = q.shape[0]
    work, out = make_workspace(model), np.empty(6)
    v, a = into_hull(model, spatial_at(nu_r, FIRST)), into_hull(model, spatial_at(nu_r_dot, FIRST))
    no_weight = (0.0, 0.0, 0.0)
    _forces_of_links(model, work, no_weight, v, a, q, q_dot, q_ddot)
    force = into_body(model, _carry_inward(model, work, n))
    for k in range(6):
        out[k] = -force[k]
    return out


@inner
def _forces_of_links(model, work, down, v, a, q, q_dot, q_ddot):
    """Force that each link needs for its motion, I a + C v - drag - weight, from the hull out."""
    for i in range(1, q.shape[0] + 1):
        set_angle(model, work, i, q[i - 1])
        v = link_velocity(model, work, i, v, q_dot[i - 1])
        down = to_child(model, work, i, down)
        a0, a1, a2, b0, b1, b2 = motion_to_child(model, work, i, a)
        x0, x1, y0, y1 = velocity_product(v, q_dot[i - 1])
        a = (a0 + x0, a1 + x1, a2, b0 + y0, b1 + y1, b2 + q_ddot[i - 1])
        inertia_force = times(load_inertia(model, i, INERTIA), a)
        set_link_force(model, work, i, v, down, inertia_force)
    apply_drag(model, work)


@inner
def _carry_inward(model, work, n):
    """Sum of the links' forces at the hull, eq. (14)-(15); FORCE of row i: through joint i."""
    force = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for i in range(n, 0, -1):
        force = plus(load6(work, i, FORCE), force)
        store_spatial(work, i, FORCE, force)
        force = force_to_parent(model, work, i, force)
    return force
