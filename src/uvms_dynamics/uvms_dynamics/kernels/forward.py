"""Forward dynamics of vehicle and arm together by articulated bodies."""

import numpy as np

from uvms_dynamics.kernels.hull import damping
from uvms_dynamics.kernels.inertia import add_to_parent, copy_inertia
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    ACCELERATION,
    AXIS_FORCE,
    DOWN,
    FORCE,
    HULL,
    INVERSE,
    LAST_ROW,
    REST,
    ROTOR,
    VELOCITY,
)
from uvms_dynamics.kernels.motion import (
    bias_force,
    carry_down,
    carry_velocity,
    down_in_body,
    make_workspace,
    resist,
)
from uvms_dynamics.kernels.solve import solve_symmetric
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
def forward_dynamics(model, quat, nu_r, q, q_dot, tau):
    """Accelerations (6+n,) = (nu_r_dot, q_ddot) under tau (6+n,) = (body wrench, joint torques).

    The whole system at once, no lagged acceleration; weight, buoyancy, damping and drag are
    counted, joint friction and stops are not. Articulated-body algorithm (Featherstone 2008,
    sec. 7.3 and 9.4) with a general symmetric 6x6 inertia, rigid and added mass, per body.
    """
    out = np.empty(6 + q.shape[0])
    work = make_workspace(q.shape[0])
    forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, work, out)
    return out


@inner
def forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, work, out):
    """`forward_dynamics` without allocation: scratch in work, result in out (6+n,)."""
    n = q.shape[0]
    bodies, joints = model.bodies, model.joints
    strips, start, coefficient = model.strips, model.strip_start, model.drag_coefficient
    k0, k1, k2 = down_in_body(quat[0], quat[1], quat[2], quat[3])
    store3(work, HULL, DOWN, k0, k1, k2)
    store(work, HULL, VELOCITY, nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5])
    bias_force(bodies, work, HULL)
    _hull_forces(model.hull, tau, work)
    copy_inertia(bodies, work, HULL)
    for i in range(1, n + 1):  # outward: velocities and bias forces
        set_rotation(joints, work, i, q[i - 1])
        carry_down(work, i)
        x0, x1, y0, y1 = carry_velocity(joints, work, i, q_dot[i - 1])
        store(work, i, ACCELERATION, x0, x1, 0.0, y0, y1, 0.0)
        bias_force(bodies, work, i)
        resist(strips, start, coefficient, work, i)
        copy_inertia(bodies, work, i)
    for i in range(n, 0, -1):  # inward: articulated inertias and bias forces
        _release_joint(work, i, tau[5 + i], joints[i, ROTOR])
        _hand_bias_on(joints, work, i)
        add_to_parent(joints, work, i)
    _hull_acceleration(work, out)
    for i in range(1, n + 1):  # outward: accelerations
        out[5 + i] = _joint_acceleration(joints, work, i)


@inner
def _hull_forces(hull, tau, work):
    """Damping of the hull less the body wrench, added to its bias force."""
    for k in range(6):
        work[0, FORCE + k] += damping(hull, k, work[0, VELOCITY + k]) - tau[k]


@inner
def _release_joint(work, i, torque, rotor):
    """Articulated inertia of link i, free about its joint: I - U U^T / D.

    U = I S, D = S^T U + rotor, u = tau - S^T p. The joint's motion S is a turn about z, so U is
    the last column of I.
    """
    u0, u1, u2, u3, u4, u5 = load(work, i, LAST_ROW)  # the matrix is symmetric
    inverse = 1.0 / (u5 + rotor)
    store(work, i, AXIS_FORCE, u0, u1, u2, u3, u4, u5)
    work[i, INVERSE] = inverse
    work[i, REST] = torque - work[i, FORCE + 5]
    for row in range(6):
        scaled = -inverse * work[i, AXIS_FORCE + row]
        add(
            work, i, 6 * row,
            scaled * u0, scaled * u1, scaled * u2, scaled * u3, scaled * u4, scaled * u5,
        )  # fmt: skip


@inner
def _hand_bias_on(joints, work, i):
    """Bias force p + I c + U u / D of link i, added to its parent's."""
    c0, c1, c2, d0, d1, d2 = load(work, i, ACCELERATION)
    f0, f1, f2, n0, n1, n2 = times(work, i, c0, c1, c2, d0, d1, d2)
    add(work, i, FORCE, f0, f1, f2, n0, n1, n2)
    gain = work[i, REST] * work[i, INVERSE]
    u0, u1, u2, u3, u4, u5 = load(work, i, AXIS_FORCE)
    add(work, i, FORCE, gain * u0, gain * u1, gain * u2, gain * u3, gain * u4, gain * u5)
    f0, f1, f2, n0, n1, n2 = load(work, i, FORCE)
    f0, f1, f2, n0, n1, n2 = force_to_parent(joints, work, i, f0, f1, f2, n0, n1, n2)
    add(work, i - 1, FORCE, f0, f1, f2, n0, n1, n2)


@inner
def _hull_acceleration(work, out):
    """Solve the articulated inertia of the hull for its acceleration."""
    for k in range(6):
        out[k] = -work[0, FORCE + k]
    solve_symmetric(work, out)
    for k in range(6):
        work[0, ACCELERATION + k] = out[k]


@inner
def _joint_acceleration(joints, work, i):
    """Acceleration of link i from its parent's; returns the joint's own."""
    a0, a1, a2, b0, b1, b2 = load(work, i - 1, ACCELERATION)
    a0, a1, a2, b0, b1, b2 = motion_to_child(joints, work, i, a0, a1, a2, b0, b1, b2)
    add(work, i, ACCELERATION, a0, a1, a2, b0, b1, b2)
    a0, a1, a2, b0, b1, b2 = load(work, i, ACCELERATION)
    u0, u1, u2, u3, u4, u5 = load(work, i, AXIS_FORCE)
    needed = u0 * a0 + u1 * a1 + u2 * a2 + u3 * b0 + u4 * b1 + u5 * b2
    result = (work[i, REST] - needed) * work[i, INVERSE]
    work[i, ACCELERATION + 5] = b2 + result
    return result
