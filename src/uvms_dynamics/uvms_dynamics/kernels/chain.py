"""Where the arm's frames and the tool are: poses, Jacobian, weight and buoyancy."""

import numpy as np

from uvms_dynamics.kernels.arithmetic import sine_cosine
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    COS_TURN,
    COS_TWIST,
    FIRST,
    HULL,
    NET_MOMENT,
    NET_WEIGHT,
    OFFSET,
    PLACE,
    SIN_TURN,
    SIN_TWIST,
    TOOL_POSITION,
    TOOL_ROTATION,
)
from uvms_dynamics.kernels.motion import check_joints, check_quaternion, down_in_body
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.kernels.spatial import cross, load3

# A frame in the body frame is a row of twelve: its rotation row by row, then its origin.
_ORIGIN = np.int64(9)
_FRAME_COLUMNS = 12


@inner
def joint_frames(model, q, frames):
    """Rows 0..n of frames (n+1, 12): the frames of the hull and the joints in the body frame."""
    c, s = model[HULL, COS_TURN], model[HULL, SIN_TURN]
    for k in range(_FRAME_COLUMNS):
        frames[0, k] = 0.0
    frames[0, 0], frames[0, 1], frames[0, 3], frames[0, 4], frames[0, 8] = c, -s, s, c, 1.0
    for i in range(1, q.shape[0] + 1):
        p0, p1, p2 = load3(model, i, PLACE)
        x0, x1, x2 = _apply(frames, i - 1, p0, p1, p2)
        frames[i, _ORIGIN] = frames[i - 1, _ORIGIN] + x0
        frames[i, _ORIGIN + 1] = frames[i - 1, _ORIGIN + 1] + x1
        frames[i, _ORIGIN + 2] = frames[i - 1, _ORIGIN + 2] + x2
        s, c = sine_cosine(q[i - 1] + model[i, OFFSET])
        _set_axes(model, frames, i, c, s)


@inner
def _set_axes(model, frames, i, c, s):
    """Rotation of frame i: its parent's, Rx of the twist, then Rz of the joint."""
    ct, st = model[i, COS_TWIST], model[i, SIN_TWIST]
    for k in range(0, _ORIGIN, 3):
        x, y, z = load3(frames, i - 1, k)
        y, z = ct * y + st * z, ct * z - st * y
        frames[i, k], frames[i, k + 1], frames[i, k + 2] = x * c + y * s, y * c - x * s, z


@inner
def _apply(frames, i, x, y, z):
    """Components in the body frame of a vector of frame i."""
    return (
        frames[i, 0] * x + frames[i, 1] * y + frames[i, 2] * z,
        frames[i, 3] * x + frames[i, 4] * y + frames[i, 5] * z,
        frames[i, 6] * x + frames[i, 7] * y + frames[i, 8] * z,
    )


@inner
def _tool_position(model, frames, n):
    """Tool in the body frame."""
    p0, p1, p2 = load3(model, n + 1, TOOL_POSITION)
    x0, x1, x2 = _apply(frames, n, p0, p1, p2)
    return frames[n, _ORIGIN] + x0, frames[n, _ORIGIN + 1] + x1, frames[n, _ORIGIN + 2] + x2


@kernel
def end_effector(model, position, quat, q):
    """Tool position (3,) and rotation (3, 3) in the world; eq. (1), corrected from the print.

    position (3,) m and quat (4,) are the vehicle's pose in the world, q (n,) rad.
    """
    check_quaternion(quat)
    check_joints(model, q, q, q)
    n = q.shape[0]
    frames = np.empty((n + 1, _FRAME_COLUMNS))
    joint_frames(model, q, frames)
    body = quat_to_matrix(quat)
    x, y, z = _tool_position(model, frames, n)
    place, turned = np.empty(3), np.empty((3, 3))
    for row in range(3):
        b0, b1, b2 = body[row, 0], body[row, 1], body[row, 2]
        place[row] = position[row] + b0 * x + b1 * y + b2 * z
        for column in range(3):
            k = TOOL_ROTATION + column
            t0, t1, t2 = _apply(
                frames, n, model[n + 1, k], model[n + 1, k + 3], model[n + 1, k + 6]
            )
            turned[row, column] = b0 * t0 + b1 * t1 + b2 * t2
    return place, turned


@kernel
def end_effector_jacobian(model, quat, q):
    """J (6, 6+n) from (nu, q_dot), nu in the body frame, to the tool's (v, omega) in the world.

    Eq. (12), corrected from the print: columns [z x (r_tool - r_joint); z] of the joints.
    """
    check_quaternion(quat)
    check_joints(model, q, q, q)
    n = q.shape[0]
    frames = np.empty((n + 1, _FRAME_COLUMNS))
    joint_frames(model, q, frames)
    body = quat_to_matrix(quat)
    x, y, z = _tool_position(model, frames, n)
    jacobian = np.zeros((6, 6 + n))
    unit = np.eye(3)
    for k in range(3):
        axis = load3(unit, k, FIRST)
        _column(jacobian, k, body, axis, (0.0, 0.0, 0.0))
        _column(jacobian, 3 + k, body, cross(axis, (x, y, z)), axis)
    for i in range(1, n + 1):
        axis = (frames[i, 2], frames[i, 5], frames[i, 8])
        o0, o1, o2 = load3(frames, i, _ORIGIN)
        _column(jacobian, 5 + i, body, cross(axis, (x - o0, y - o1, z - o2)), axis)
    return jacobian


@inner
def _column(jacobian, column, body, linear, angular):
    """One column, turned from body to world axes."""
    for row in range(3):
        b0, b1, b2 = body[row, 0], body[row, 1], body[row, 2]
        jacobian[row, column] = b0 * linear[0] + b1 * linear[1] + b2 * linear[2]
        jacobian[3 + row, column] = b0 * angular[0] + b1 * angular[1] + b2 * angular[2]


@kernel
def restoring_wrench(model, quat, q):
    """Weight and buoyancy (6,) of hull and links ON the system, body frame, about its origin.

    Eq. (13), with the sign of buoyancy and the names of CB and CG corrected from the print:
    f = sum (m g - rho V g) k, n = P x k, P = sum m g r_g - rho V g r_b, k the down direction.
    """
    check_quaternion(quat)
    check_joints(model, q, q, q)
    n = q.shape[0]
    frames = np.empty((n + 1, _FRAME_COLUMNS))
    joint_frames(model, q, frames)
    total, p0, p1, p2 = 0.0, 0.0, 0.0, 0.0
    for i in range(n + 1):
        w = model[i, NET_WEIGHT]
        m0, m1, m2 = load3(model, i, NET_MOMENT)
        m0, m1, m2 = _apply(frames, i, m0, m1, m2)
        total += w
        p0 += w * frames[i, _ORIGIN] + m0
        p1 += w * frames[i, _ORIGIN + 1] + m1
        p2 += w * frames[i, _ORIGIN + 2] + m2
    down = down_in_body(quat[0], quat[1], quat[2], quat[3])
    out = np.empty(6)
    out[0], out[1], out[2] = total * down[0], total * down[1], total * down[2]
    out[3], out[4], out[5] = cross((p0, p1, p2), down)
    return out
