"""Forward dynamics of vehicle and arm together by articulated bodies."""

import numpy as np

from uvms_dynamics.kernels.inertia import add_to_parent, copy_inertia
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    ACCELERATION,
    ANGULAR,
    ARTICULATED,
    AXIS_FORCE,
    COUPLING,
    DOWN,
    FORCE,
    HULL,
    INVERSE,
    LINEAR,
    LINEAR_PART,
    RATE,
    ROTOR,
    TORQUE,
    VELOCITY,
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
from uvms_dynamics.kernels.solve import solve_inertia
from uvms_dynamics.kernels.spatial import (
    add,
    force_to_parent,
    load,
    load3,
    motion_to_child,
    store,
    store3,
)


@kernel
def forward_dynamics(model, quat, nu_r, q, q_dot, tau):
    """Accelerations (6+n,) = (nu_r_dot, q_ddot) under tau (6+n,) = (body wrench, joint torques).

    The whole system at once, no lagged acceleration; weight, buoyancy, damping and drag are
    counted, joint friction and stops are not. Articulated-body algorithm (Featherstone 2008,
    sec. 7.3 and 9.4) with a general symmetric 6x6 inertia, rigid and added mass, per body.
    """
    n = q.shape[0]
    work, out = make_workspace(n), np.empty(6 + n)
    set_hull(model, work, down_in_body(quat[0], quat[1], quat[2], quat[3]), nu_r, LINEAR_PART)
    for i in range(1, n + 1):
        set_angle(model, work, i, q[i - 1])
        work[i, RATE], work[i, TORQUE] = q_dot[i - 1], tau[5 + i]
    f0, f1, f2 = to_hull(model, tau[0], tau[1], tau[2])
    n0, n1, n2 = to_hull(model, tau[3], tau[4], tau[5])
    accelerate(model, work, n, f0, f1, f2, n0, n1, n2)
    out[0], out[1], out[2] = to_body(model, *load3(work, HULL, ACCELERATION))
    out[3], out[4], out[5] = to_body(model, *load3(work, HULL, ACCELERATION + 3))
    for i in range(1, n + 1):
        out[5 + i] = work[i, RATE]
    return out


@inner
def set_hull(model, work, down, nu_r, k):
    """Down direction and velocity of the hull, the latter from nu_r[k : k + 6], body axes."""
    store3(work, HULL, DOWN, *to_hull(model, *down))
    store3(work, HULL, VELOCITY, *to_hull(model, nu_r[k], nu_r[k + 1], nu_r[k + 2]))
    store3(work, HULL, VELOCITY + 3, *to_hull(model, nu_r[k + 3], nu_r[k + 4], nu_r[k + 5]))


@inner
def accelerate(model, work, n, f0, f1, f2, n0, n1, n2):
    """Acceleration of the hull and RATE of the joints become accelerations, in place.

    The workspace holds the hull's velocity and down direction, and angle, rate and torque of each
    joint; (f, n) is the wrench on the hull, in its frame.
    """
    store(work, HULL, FORCE, *hull_bias_force(model, work))
    add(work, HULL, FORCE, -f0, -f1, -f2, -n0, -n1, -n2)
    copy_inertia(model, work, HULL)
    for i in range(1, n + 1):  # outward: velocities and bias forces
        x0, x1, y0, y1 = carry_velocity(model, work, i)
        work[i, ACCELERATION], work[i, ACCELERATION + 1] = x0, x1
        work[i, ACCELERATION + 3], work[i, ACCELERATION + 4] = y0, y1
        carry_down(model, work, i)
        store(work, i, FORCE, *link_bias_force(model, work, i))
        copy_inertia(model, work, i)
    for i in range(n, 0, -1):  # inward: articulated inertias and bias forces
        _release_joint(model, work, i)
        _hand_bias_on(model, work, i)
        add_to_parent(model, work, i)
    f0, f1, f2, n0, n1, n2 = load(work, HULL, FORCE)
    store(work, HULL, ACCELERATION, *solve_inertia(work, HULL, -f0, -f1, -f2, -n0, -n1, -n2))
    for i in range(1, n + 1):  # outward: accelerations
        _accelerate_joint(model, work, i)


@inner
def _release_joint(model, work, i):
    """Articulated inertia of link i, free about its joint: I - U U^T / D.

    U = I S, D = S^T U + rotor, u = tau - S^T p. The joint's motion S is a turn about z, so U is
    the last column of I.
    """
    b, c = ARTICULATED + COUPLING, ARTICULATED + ANGULAR
    u0, u1, u2 = work[i, b + 2], work[i, b + 5], work[i, b + 8]
    u3, u4, u5 = work[i, c + 2], work[i, c + 4], work[i, c + 5]
    inverse = 1.0 / (u5 + model[i, ROTOR])
    store(work, i, AXIS_FORCE, u0, u1, u2, u3, u4, u5)
    work[i, INVERSE] = inverse
    work[i, TORQUE] -= work[i, FORCE + 5]
    s0, s1, s2, s3, s4 = inverse * u0, inverse * u1, inverse * u2, inverse * u3, inverse * u4
    add(work, i, ARTICULATED + LINEAR, -s0 * u0, -s0 * u1, -s0 * u2, -s1 * u1, -s1 * u2, -s2 * u2)
    add(work, i, b, -s0 * u3, -s0 * u4, -s0 * u5, -s1 * u3, -s1 * u4, -s1 * u5)
    work[i, b + 6] -= s2 * u3
    work[i, b + 7] -= s2 * u4
    work[i, b + 8] -= s2 * u5
    add(work, i, c, -s3 * u3, -s3 * u4, -s3 * u5, -s4 * u4, -s4 * u5, -inverse * u5 * u5)


@inner
def _hand_bias_on(model, work, i):
    """Add the bias force p + I c + U u / D of link i to its parent's."""
    gain = work[i, TORQUE] * work[i, INVERSE]
    f0, f1, f2, n0, n1, n2 = _times_velocity_product(work, i)
    u0, u1, u2, u3, u4, u5 = load(work, i, AXIS_FORCE)
    p0, p1, p2, p3, p4, p5 = load(work, i, FORCE)
    f0, f1, f2 = p0 + (f0 + gain * u0), p1 + (f1 + gain * u1), p2 + (f2 + gain * u2)
    n0, n1, n2 = p3 + (n0 + gain * u3), p4 + (n1 + gain * u4), p5 + (n2 + gain * u5)
    f0, f1, f2, n0, n1, n2 = force_to_parent(model, work, i, f0, f1, f2, n0, n1, n2)
    add(work, i - 1, FORCE, f0, f1, f2, n0, n1, n2)


@inner
def _times_velocity_product(work, i):
    """I c with the velocity product c = V x S q_dot, which has no part along z."""
    b, k = ARTICULATED + COUPLING, ACCELERATION
    x0, x1, y0, y1 = work[i, k], work[i, k + 1], work[i, k + 3], work[i, k + 4]
    a00, a01, a02, a11, a12, _ = load(work, i, ARTICULATED + LINEAR)
    c00, c01, c02, c11, c12, _ = load(work, i, ARTICULATED + ANGULAR)
    b00, b01, b02 = load3(work, i, b)
    b10, b11, b12 = load3(work, i, b + 3)
    b20, b21, _ = load3(work, i, b + 6)
    return (
        a00 * x0 + a01 * x1 + (b00 * y0 + b01 * y1),
        a01 * x0 + a11 * x1 + (b10 * y0 + b11 * y1),
        a02 * x0 + a12 * x1 + (b20 * y0 + b21 * y1),
        b00 * x0 + b10 * x1 + (c00 * y0 + c01 * y1),
        b01 * x0 + b11 * x1 + (c01 * y0 + c11 * y1),
        b02 * x0 + b12 * x1 + (c02 * y0 + c12 * y1),
    )


@inner
def _accelerate_joint(model, work, i):
    """Acceleration of link i and of its joint from its parent's."""
    k = ACCELERATION
    a0, a1, a2, b0, b1, b2 = load(work, i - 1, k)
    a0, a1, a2, b0, b1, b2 = motion_to_child(model, work, i, a0, a1, a2, b0, b1, b2)
    a0, a1 = a0 + work[i, k], a1 + work[i, k + 1]
    b0, b1 = b0 + work[i, k + 3], b1 + work[i, k + 4]
    u0, u1, u2, u3, u4, u5 = load(work, i, AXIS_FORCE)
    needed = (u0 * a0 + u1 * a1 + u2 * a2) + (u3 * b0 + u4 * b1 + u5 * b2)
    result = (work[i, TORQUE] - needed) * work[i, INVERSE]
    work[i, RATE] = result
    store(work, i, k, a0, a1, a2, b0, b1, b2 + result)
