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
    into_body,
    into_hull,
    link_velocity,
    make_workspace,
    set_angle,
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
from uvms_dynamics.kernels.waves import hull_bias_force_in, set_link_force_in


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
    down = down_in_body(quat[0], quat[1], quat[2], quat[3])
    return _needed(model, None, down, nu_r, nu_r_dot, q, q_dot, q_ddot)


@kernel
def inverse_dynamics_in(model, wet, down, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """As `inverse_dynamics`, in moving water: `wet` as in `waves`, None in a uniform flow.

    down (3,) in body axes, as weight and buoyancy act in the frame that nu_r is relative to.
    """
    check_motion(nu_r, nu_r_dot)
    check_joints(model, q, q_dot, q_ddot)
    downward = down[0], down[1], down[2]
    return _needed(model, wet, downward, nu_r, nu_r_dot, q, q_dot, q_ddot)


@inner
def _needed(model, wet, down, nu_r, nu_r_dot, q, q_dot, q_ddot):
    n = q.shape[0]
    work, out = make_workspace(model), np.empty(6 + n)
    down = to_hull(model, down)
    v, a = into_hull(model, spatial_at(nu_r, FIRST)), into_hull(model, spatial_at(nu_r_dot, FIRST))
    _forces_of_links(model, wet, work, down, v, a, q, q_dot, q_ddot)
    bias = hull_bias_force_in(model, wet, v, down)
    force = plus(bias, times(load_inertia(model, HULL, INERTIA), a))
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
    return _handed_over(model, None, (0.0, 0.0, 0.0), nu_r, nu_r_dot, q, q_dot, q_ddot)


@kernel
def coupling_wrench_in(model, wet, tilt, nu_r, nu_r_dot, q, q_dot, q_ddot):
    """As `coupling_wrench`, in moving water: `wet` as in `waves`, None in a uniform flow.

    tilt (3,) is what the acceleration of the frame that nu_r is relative to adds to down, -A / g
    in body axes: the links' inertia is over ground, only their weight is left out.
    """
    check_motion(nu_r, nu_r_dot)
    check_joints(model, q, q_dot, q_ddot)
    downward = tilt[0], tilt[1], tilt[2]
    return _handed_over(model, wet, downward, nu_r, nu_r_dot, q, q_dot, q_ddot)


@inner
def _handed_over(model, wet, down, nu_r, nu_r_dot, q, q_dot, q_ddot):
    n = q.shape[0]
    work, out = make_workspace(model), np.empty(6)
    v, a = into_hull(model, spatial_at(nu_r, FIRST)), into_hull(model, spatial_at(nu_r_dot, FIRST))
    _forces_of_links(model, wet, work, to_hull(model, down), v, a, q, q_dot, q_ddot)
    force = into_body(model, _carry_inward(model, work, n))
    for k in range(6):
        out[k] = -force[k]
    return out


@inner
def _forces_of_links(model, wet, work, down, v, a, q, q_dot, q_ddot):
    """Force that each link needs for its motion, I a + C v - drag - weight, from the hull out."""
    for i in range(1, q.shape[0] + 1):
        set_angle(model, work, i, q[i - 1])
        v = link_velocity(model, work, i, v, q_dot[i - 1])
        down = to_child(model, work, i, down)
        a0, a1, a2, b0, b1, b2 = motion_to_child(model, work, i, a)
        x0, x1, y0, y1 = velocity_product(v, q_dot[i - 1])
        a = (a0 + x0, a1 + x1, a2, b0 + y0, b1 + y1, b2 + q_ddot[i - 1])
        inertia_force = times(load_inertia(model, i, INERTIA), a)
        set_link_force_in(model, wet, work, i, v, down, inertia_force)
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
