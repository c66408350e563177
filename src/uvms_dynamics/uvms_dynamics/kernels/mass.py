"""Mass matrix of the whole system by composite bodies."""

import numpy as np

from uvms_dynamics.kernels.inertia import add_to_parent, copy_inertia
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import HULL, LAST_ROW, ROTOR
from uvms_dynamics.kernels.motion import make_workspace
from uvms_dynamics.kernels.spatial import force_to_parent, load, set_rotation


@kernel
def mass_matrix(model, q):
    """M(q) (6+n, 6+n): rigid bodies, added mass and rotors; symmetric positive definite.

    Rows and columns: body wrench and nu_r_dot, then joint torques and q_ddot; q (n,) rad.
    Composite-rigid-body algorithm (Featherstone 2008, sec. 6.2) with a general symmetric inertia.
    """
    n = q.shape[0]
    bodies, joints = model.bodies, model.joints
    work, matrix = make_workspace(n), np.empty((6 + n, 6 + n))
    copy_inertia(bodies, work, HULL)
    for i in range(1, n + 1):
        set_rotation(joints, work, i, q[i - 1])
        copy_inertia(bodies, work, i)
    for i in range(n, 0, -1):
        _joint_row(joints, work, i, matrix)
        add_to_parent(joints, work, i)
    for row in range(6):
        for column in range(6):
            matrix[row, column] = work[0, 6 * row + column]
    return matrix


@inner
def _joint_row(joints, work, i, matrix):
    """Row and column of joint i: the force of a unit acceleration, carried to the base."""
    f0, f1, f2, n0, n1, n2 = load(work, i, LAST_ROW)
    matrix[5 + i, 5 + i] = n2 + joints[i, ROTOR]
    for j in range(i, 0, -1):
        f0, f1, f2, n0, n1, n2 = force_to_parent(joints, work, j, f0, f1, f2, n0, n1, n2)
        if j > 1:
            matrix[5 + i, 4 + j] = matrix[4 + j, 5 + i] = n2
    matrix[0, 5 + i] = matrix[5 + i, 0] = f0
    matrix[1, 5 + i] = matrix[5 + i, 1] = f1
    matrix[2, 5 + i] = matrix[5 + i, 2] = f2
    matrix[3, 5 + i] = matrix[5 + i, 3] = n0
    matrix[4, 5 + i] = matrix[5 + i, 4] = n1
    matrix[5, 5 + i] = matrix[5 + i, 5] = n2
