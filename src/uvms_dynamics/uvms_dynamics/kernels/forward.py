"""Forward dynamics of vehicle and arm together by articulated bodies."""

import numpy as np

from uvms_dynamics.kernels.drag import apply_drag
from uvms_dynamics.kernels.inertia import (
    articulated_inertia,
    axis_force,
    inertia_to_parent,
    load_inertia,
    plus_inertia,
    solve_inertia,
)
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    AXIS_FORCE,
    FIRST,
    FORCE,
    HULL,
    INERTIA,
    INVERSE,
    RATE,
    ROTOR,
    TORQUE,
    VELOCITY_PRODUCT,
)
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
from uvms_dynamics.kernels.numba_internals.primitives import zero_like
from uvms_dynamics.kernels.spatial import (
    force_to_parent,
    linear,
    load6,
    minus,
    motion_to_child,
    plus,
    spatial_at,
    store_spatial,
    to_child,
)
from uvms_dynamics.kernels.waves import hull_bias_force_in, set_link_force_in


@kernel
def forward_dynamics(model, quat, nu_r, q, q_dot, tau):
    """Accelerations (6+n,) = (nu_r_dot, q_ddot) under tau (6+n,) = (body wrench, joint torques).

    quat (4,) is a unit quaternion. The whole system at once, no lagged acceleration; weight,
    buoyancy, damping and drag are counted, joint friction and stops are not. Articulated-body
    algorithm (Featherstone 2008, sec. 7.3 and 9.4) with a general symmetric 6x6 inertia, rigid and
    added mass, per body. Raises ValueError for arrays of the wrong length.
    """
    check_quaternion(quat)
    check_motion(nu_r, nu_r)
    check_joints(model, q, q_dot, tau[6:])
    out = np.empty(6 + q.shape[0])
    forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, make_workspace(model), out)
    return out


@inner
def forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, work, out):
    """`forward_dynamics` without allocation: scratch in work, result in out (6+n,)."""
    n = q.shape[0]
    down = down_in_body(quat[0], quat[1], quat[2], quat[3])
    nu = spatial_at(nu_r, FIRST)
    wrench = spatial_at(tau, FIRST)
    for i in range(1, n + 1):
        set_angle(model, work, i, q[i - 1])
        work[i, RATE], work[i, TORQUE] = q_dot[i - 1], tau[5 + i]
    a = accelerate(model, work, None, n, down, nu, wrench)
    out[0], out[1], out[2], out[3], out[4], out[5] = a
    for i in range(1, n + 1):
        out[5 + i] = work[i, RATE]


@inner
def accelerate(model, work, wet, n, down, nu_r, wrench):
    """Acceleration of the hull; RATE of the joints becomes their acceleration.

    The workspace holds angle, rate and torque of each joint; the down direction, nu_r and the
    wrench on the hull are given in the body frame, as is the result. `wet` is that of `waves`;
    None where the flow is uniform.
    """
    v, k = into_hull(model, nu_r), to_hull(model, down)
    zero = _zeros(v[0])
    bias = minus(hull_bias_force_in(model, wet, v, k), into_hull(model, wrench))
    for i in range(1, n + 1):  # outward: velocities and bias forces
        rate = work[i, RATE]
        v, k = link_velocity(model, work, i, v, rate), to_child(model, work, i, k)
        _store4(work, i, VELOCITY_PRODUCT, velocity_product(v, rate))
        set_link_force_in(model, wet, work, i, v, k, zero)
    apply_drag(model, work)
    inertia, force = _gather(model, work, n, v)
    inertia = plus_inertia(load_inertia(model, HULL, INERTIA), inertia)
    a = solve_inertia(inertia, minus(_negated(bias), force))
    result = into_body(model, a)
    for i in range(1, n + 1):  # outward: accelerations
        a = _accelerate_joint(model, work, i, a)
    return result


@inner
def _gather(model, work, n, like):
    """Articulated inertia and bias force of the whole arm at the hull, from the tip inward."""
    force = _zeros(like[0])
    inertia = force + force + force + linear(force)
    for i in range(n, 0, -1):
        inertia = plus_inertia(load_inertia(model, i, INERTIA), inertia)
        force = plus(load6(work, i, FORCE), force)
        # I - U U^T / D with U = I S, D = S^T U + rotor, and p + I c + U (tau - S^T p) / D
        u = axis_force(inertia)
        inverse = 1.0 / (u[5] + model[i, ROTOR])
        rest = work[i, TORQUE] - force[5]
        store_spatial(work, i, AXIS_FORCE, u)
        work[i, INVERSE], work[i, TORQUE] = inverse, rest
        inertia = articulated_inertia(inertia, u, inverse)
        force = plus(force, _times_velocity_product(inertia, work, i))
        force = plus(force, _scaled(rest * inverse, u))
        force = force_to_parent(model, work, i, force)
        inertia = inertia_to_parent(model, work, i, inertia)
    return inertia, force


@inner
def _accelerate_joint(model, work, i, a):
    """Acceleration of link i from its parent's, and of its joint."""
    k = VELOCITY_PRODUCT
    a0, a1, a2, b0, b1, b2 = motion_to_child(model, work, i, a)
    a0, a1 = a0 + work[i, k], a1 + work[i, k + 1]
    b0, b1 = b0 + work[i, k + 2], b1 + work[i, k + 3]
    u0, u1, u2, u3, u4, u5 = load6(work, i, AXIS_FORCE)
    needed = (u0 * a0 + u1 * a1 + u2 * a2) + (u3 * b0 + u4 * b1 + u5 * b2)
    result = (work[i, TORQUE] - needed) * work[i, INVERSE]
    work[i, RATE] = result
    return a0, a1, a2, b0, b1, b2 + result


@inner
def _times_velocity_product(inertia, work, i):
    """I c with the velocity product c, which has no parts along z."""
    a00, a01, a02, a11, a12, _ = inertia[:6]
    b00, b01, b02, b10, b11, b12, b20, b21, _ = inertia[6:15]
    c00, c01, c02, c11, c12, _ = inertia[15:]
    k = VELOCITY_PRODUCT
    x0, x1, y0, y1 = work[i, k], work[i, k + 1], work[i, k + 2], work[i, k + 3]
    return (
        (a00 * x0 + a01 * x1) + (b00 * y0 + b01 * y1),
        (a01 * x0 + a11 * x1) + (b10 * y0 + b11 * y1),
        (a02 * x0 + a12 * x1) + (b20 * y0 + b21 * y1),
        (b00 * x0 + b10 * x1) + (c00 * y0 + c01 * y1),
        (b01 * x0 + b11 * x1) + (c01 * y0 + c11 * y1),
        (b02 * x0 + b12 * x1) + (c02 * y0 + c12 * y1),
    )


@inner
def _zeros(like):
    zero = zero_like(like)
    return zero, zero, zero, zero, zero, zero


@inner
def _store4(work, i, k, a):
    work[i, k], work[i, k + 1], work[i, k + 2], work[i, k + 3] = a[0], a[1], a[2], a[3]


@inner
def _scaled(s, a):
    return s * a[0], s * a[1], s * a[2], s * a[3], s * a[4], s * a[5]


@inner
def _negated(a):
    return -a[0], -a[1], -a[2], -a[3], -a[4], -a[5]
