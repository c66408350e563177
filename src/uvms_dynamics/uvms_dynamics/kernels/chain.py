"""Where the arm's frames and the tool are: poses, Jacobian, weight and buoyancy."""

import numpy as np
from numba import njit

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.spatial import cross, turn_about_z
from uvms_dynamics.rotations import quat_to_matrix

_inlined = njit(cache=True, error_model="numpy", forceinline=True)  # `inner` that may allocate


@inner
def down_in_body(quat):
    """World's down (0, 0, 1) in the body frame: the last row of R_world_body."""
    x, y, z, w = quat[0], quat[1], quat[2], quat[3]
    return 2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)


@inner
def joint_rotations(model, q, rotation):
    """Set rotation[i] (3, 3) of each joint frame to its parent; q (n,) rad."""
    for i in range(q.shape[0]):
        turn_about_z(model.tree_rotation, i, q[i] + model.joint_offset[i], rotation)


@_inlined
def joint_frames(model, q):
    """Origins (n, 3) and rotations (n, 3, 3) of the joint frames in the body frame."""
    n = q.shape[0]
    local = np.empty((n, 3, 3))
    joint_rotations(model, q, local)
    origin, rotation = np.empty((n, 3)), np.empty((n, 3, 3))
    for i in range(n):
        if i == 0:
            origin[0, :], rotation[0, :, :] = model.tree_position[0], local[0]
        else:
            _place(origin, rotation, i, model.tree_position[i], local[i])
    return origin, rotation


@inner
def _place(origin, rotation, i, position, turned):
    """Frame i from frame i - 1 and its pose in it."""
    for row in range(3):
        total = origin[i - 1, row]
        for k in range(3):
            total += rotation[i - 1, row, k] * position[k]
        origin[i, row] = total
        for column in range(3):
            total = 0.0
            for k in range(3):
                total += rotation[i - 1, row, k] * turned[k, column]
            rotation[i, row, column] = total


@_inlined
def tool_in_body(model, origin, rotation):
    """Tool position (3,) and rotation (3, 3) in the body frame, from the joint frames."""
    last = origin.shape[0] - 1
    place, turned = np.empty(3), np.empty((3, 3))
    for row in range(3):
        place[row] = origin[last, row]
        for k in range(3):
            place[row] += rotation[last, row, k] * model.tool_position[k]
        for column in range(3):
            total = 0.0
            for k in range(3):
                total += rotation[last, row, k] * model.tool_rotation[k, column]
            turned[row, column] = total
    return place, turned


@kernel
def end_effector(model, position, quat, q):
    """Tool position (3,) and rotation (3, 3) in the world; eq. (1), corrected from the print.

    position (3,) m and quat (4,) are the vehicle's pose in the world, q (n,) rad.
    """
    origin, rotation = joint_frames(model, q)
    place, turned = tool_in_body(model, origin, rotation)
    body = quat_to_matrix(quat)
    p, out = np.empty(3), np.empty((3, 3))
    for row in range(3):
        p[row] = position[row]
        for k in range(3):
            p[row] += body[row, k] * place[k]
        for column in range(3):
            total = 0.0
            for k in range(3):
                total += body[row, k] * turned[k, column]
            out[row, column] = total
    return p, out


@kernel
def end_effector_jacobian(model, quat, q):
    """J (6, 6+n) from (nu, q_dot), nu in the body frame, to the tool's (v, omega) in the world.

    Eq. (12), corrected from the print: columns [z x (r_tool - r_joint); z] of the joints.
    """
    n = q.shape[0]
    origin, rotation = joint_frames(model, q)
    tool, _ = tool_in_body(model, origin, rotation)
    body = quat_to_matrix(quat)
    jacobian = np.zeros((6, 6 + n))
    unit = np.eye(3)
    for k in range(3):
        a0, a1, a2 = unit[k, 0], unit[k, 1], unit[k, 2]
        _column(jacobian, k, body, a0, a1, a2, 0.0, 0.0, 0.0)
        l0, l1, l2 = cross(a0, a1, a2, tool[0], tool[1], tool[2])
        _column(jacobian, 3 + k, body, l0, l1, l2, a0, a1, a2)
    for i in range(n):
        z0, z1, z2 = rotation[i, 0, 2], rotation[i, 1, 2], rotation[i, 2, 2]
        x, y, z = tool[0] - origin[i, 0], tool[1] - origin[i, 1], tool[2] - origin[i, 2]
        l0, l1, l2 = cross(z0, z1, z2, x, y, z)
        _column(jacobian, 6 + i, body, l0, l1, l2, z0, z1, z2)
    return jacobian


@inner
def _column(jacobian, column, body, l0, l1, l2, a0, a1, a2):
    """One column, turned from body to world axes."""
    for row in range(3):
        jacobian[row, column] = body[row, 0] * l0 + body[row, 1] * l1 + body[row, 2] * l2
        jacobian[3 + row, column] = body[row, 0] * a0 + body[row, 1] * a1 + body[row, 2] * a2


@kernel
def restoring_wrench(model, quat, q):
    """Weight and buoyancy (6,) of hull and links ON the system, body frame, about its origin.

    Eq. (13), with the sign of buoyancy and the names of CB and CG corrected from the print:
    f = sum (m g - rho V g) k, n = P x k, P = sum m g r_g - rho V g r_b, k the down direction.
    """
    k0, k1, k2 = down_in_body(quat)
    origin, rotation = joint_frames(model, q)
    total, p0, p1, p2 = _first_moment(model, origin, rotation)
    out = np.empty(6)
    out[0], out[1], out[2] = total * k0, total * k1, total * k2
    out[3], out[4], out[5] = cross(p0, p1, p2, k0, k1, k2)
    return out


@inner
def _first_moment(model, origin, rotation):
    """Wet weight and its first moment P in the body frame."""
    total = model.net_weight[0]
    moment = model.net_moment
    p0, p1, p2 = moment[0, 0], moment[0, 1], moment[0, 2]
    for i in range(origin.shape[0]):
        w = model.net_weight[i + 1]
        m0, m1, m2 = moment[i + 1, 0], moment[i + 1, 1], moment[i + 1, 2]
        total += w
        p0 += w * origin[i, 0] + _dot(rotation, i, 0, m0, m1, m2)
        p1 += w * origin[i, 1] + _dot(rotation, i, 1, m0, m1, m2)
        p2 += w * origin[i, 2] + _dot(rotation, i, 2, m0, m1, m2)
    return total, p0, p1, p2


@inner
def _dot(rotation, i, row, x, y, z):
    return rotation[i, row, 0] * x + rotation[i, row, 1] * y + rotation[i, row, 2] * z
