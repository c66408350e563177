"""Forward dynamics of vehicle and arm together by articulated bodies."""

import numpy as np

from uvms_dynamics.kernels.chain import down_in_body, joint_rotations
from uvms_dynamics.kernels.drag import link_drag
from uvms_dynamics.kernels.hull import hull_bias
from uvms_dynamics.kernels.inertia import add_to_parent
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.solve import solve_symmetric
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
def forward_dynamics(model, quat, nu_r, q, q_dot, tau):
    """Accelerations (6+n,) = (nu_r_dot, q_ddot) under tau (6+n,) = (body wrench, joint torques).

    The whole system at once, no lagged acceleration; weight, buoyancy, damping and drag are
    counted, joint friction and stops are not. Articulated-body algorithm (Featherstone 2008,
    sec. 7.3 and 9.4) with a general symmetric 6x6 inertia, rigid and added mass, per body.
    """
    out = np.empty(6 + q.shape[0])
    forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, make_workspace(q.shape[0]), out)
    return out


@inner
def forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, work, out):
    """`forward_dynamics` without allocation: scratch in work, result in out (6+n,)."""
    n = q.shape[0]
    joint_rotations(model, q, work.rotation)
    _start_at_hull(model, quat, nu_r, tau, work)
    for i in range(1, n + 1):
        _outward_velocity(model, i, q_dot[i - 1], work)
    for i in range(n, 0, -1):
        _inward_inertia(model, i, tau[5 + i], work)
    _hull_acceleration(work, out)
    for i in range(1, n + 1):
        out[5 + i] = _outward_acceleration(model, i, work)


@inner
def _start_at_hull(model, quat, nu_r, tau, work):
    """Velocity, inertia and bias force of the hull under the body wrench."""
    k0, k1, k2 = down_in_body(quat)
    work.down[0, 0], work.down[0, 1], work.down[0, 2] = k0, k1, k2
    v0, v1, v2, w0, w1, w2 = nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5]
    store(work.velocity, 0, v0, v1, v2, w0, w1, w2)
    f0, f1, f2, n0, n1, n2 = hull_bias(model, v0, v1, v2, w0, w1, w2)
    store(
        work.force, 0, f0 - tau[0], f1 - tau[1], f2 - tau[2], n0 - tau[3], n1 - tau[4], n2 - tau[5]
    )
    f0, f1, f2, n0, n1, n2 = weight(model, 0, k0, k1, k2)
    accumulate(work.force, 0, -f0, -f1, -f2, -n0, -n1, -n2)
    _copy_inertia(model, 0, work)


@inner
def _copy_inertia(model, i, work):
    for row in range(6):
        for column in range(6):
            work.inertia[i, row, column] = model.inertia[i, row, column]


@inner
def _outward_velocity(model, i, rate, work):
    """Velocity, velocity product, inertia and bias force of link i."""
    v0, v1, v2, w0, w1, w2 = load(work.velocity, i - 1)
    v0, v1, v2, w0, w1, w2 = motion_to_child(
        work.rotation, model.tree_position, i - 1, v0, v1, v2, w0, w1, w2
    )
    # velocity product V x S q_dot: only its first two linear and angular parts are not zero
    store(work.acceleration, i, rate * v1, -rate * v0, 0.0, rate * w1, -rate * w0, 0.0)
    w2 += rate
    store(work.velocity, i, v0, v1, v2, w0, w1, w2)
    k0, k1, k2 = work.down[i - 1, 0], work.down[i - 1, 1], work.down[i - 1, 2]
    k0, k1, k2 = turn_back(work.rotation, i - 1, k0, k1, k2)
    work.down[i, 0], work.down[i, 1], work.down[i, 2] = k0, k1, k2
    f0, f1, f2, n0, n1, n2 = gyroscopic(model.inertia, i, v0, v1, v2, w0, w1, w2)
    store(work.force, i, f0, f1, f2, n0, n1, n2)
    f0, f1, f2, n0, n1, n2 = link_drag(model, i, v0, v1, v2, w0, w1, w2)
    accumulate(work.force, i, -f0, -f1, -f2, -n0, -n1, -n2)
    f0, f1, f2, n0, n1, n2 = weight(model, i, k0, k1, k2)
    accumulate(work.force, i, -f0, -f1, -f2, -n0, -n1, -n2)
    _copy_inertia(model, i, work)


@inner
def _inward_inertia(model, i, torque, work):
    """Articulated inertia and bias force of link i, handed to its parent.

    U = I S, D = S^T U + rotor, u = tau - S^T p; I - U U^T / D and p + I c + U u / D go inward.
    The joint's motion S is a turn about z, so U is the last column of I.
    """
    table, joint = work.inertia, work.joint
    for k in range(6):
        joint[i - 1, k] = table[i, k, 5]
    inverse = 1.0 / (table[i, 5, 5] + model.rotor_inertia[i - 1])
    rest = torque - work.force[i, 5]
    joint[i - 1, 6], joint[i - 1, 7] = inverse, rest
    for row in range(6):
        scaled = joint[i - 1, row] * inverse
        for column in range(6):
            table[i, row, column] -= scaled * joint[i - 1, column]
    c0, c1, c2, d0, d1, d2 = load(work.acceleration, i)
    f0, f1, f2, n0, n1, n2 = times(table, i, c0, c1, c2, d0, d1, d2)
    accumulate(work.force, i, f0, f1, f2, n0, n1, n2)
    gain = rest * inverse
    u0, u1, u2, u3, u4, u5 = load(joint, i - 1)
    f0, f1, f2, n0, n1, n2 = load(work.force, i)
    f0, f1, f2, n0, n1, n2 = force_to_parent(
        work.rotation, model.tree_position, i - 1,
        f0 + gain * u0, f1 + gain * u1, f2 + gain * u2,
        n0 + gain * u3, n1 + gain * u4, n2 + gain * u5,
    )  # fmt: skip
    accumulate(work.force, i - 1, f0, f1, f2, n0, n1, n2)
    add_to_parent(table, i, work.rotation, model.tree_position, i - 1)


@inner
def _hull_acceleration(work, out):
    """Solve the articulated inertia of the hull for its acceleration."""
    for k in range(6):
        out[k] = -work.force[0, k]
    solve_symmetric(work.inertia, out)
    for k in range(6):
        work.acceleration[0, k] = out[k]


@inner
def _outward_acceleration(model, i, work):
    """Acceleration of link i; returns the joint's own."""
    a0, a1, a2, b0, b1, b2 = load(work.acceleration, i - 1)
    a0, a1, a2, b0, b1, b2 = motion_to_child(
        work.rotation, model.tree_position, i - 1, a0, a1, a2, b0, b1, b2
    )
    accumulate(work.acceleration, i, a0, a1, a2, b0, b1, b2)
    a0, a1, a2, b0, b1, b2 = load(work.acceleration, i)
    u0, u1, u2, u3, u4, u5 = load(work.joint, i - 1)
    needed = u0 * a0 + u1 * a1 + u2 * a2 + u3 * b0 + u4 * b1 + u5 * b2
    result = (work.joint[i - 1, 7] - needed) * work.joint[i - 1, 6]
    work.acceleration[i, 5] = b2 + result
    return result
