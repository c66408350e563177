"""Mass matrix of the whole system by composite bodies."""

import numpy as np

from uvms_dynamics.kernels.inertia import add_to_parent, copy_inertia
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    ANGULAR,
    ARTICULATED,
    COUPLING,
    HULL,
    ROTOR,
)
from uvms_dynamics.kernels.motion import make_workspace, set_angle, to_body, to_hull
from uvms_dynamics.kernels.spatial import force_to_parent, times


@kernel
def mass_matrix(model, q):
    """M(q) (6+n, 6+n): rigid bodies, added mass and rotors; symmetric positive definite.

    Rows and columns: body wrench and nu_r_dot, then joint torques and q_ddot; q (n,) rad.
    Composite-rigid-body algorithm (Featherstone 2008, sec. 6.2) with a general symmetric inertia.
    """
    n = q.shape[0]
    work, matrix = make_workspace(n), np.empty((6 + n, 6 + n))
    copy_inertia(model, work, HULL)
    for i in range(1, n + 1):
        set_angle(model, work, i, q[i - 1])
        copy_inertia(model, work, i)
    for i in range(n, 0, -1):
        _joint_row(model, work, i, matrix)
        add_to_parent(model, work, i)
    unit = np.eye(6)
    for k in range(6):
        v0, v1, v2 = to_hull(model, unit[k, 0], unit[k, 1], unit[k, 2])
        w0, w1, w2 = to_hull(model, unit[k, 3], unit[k, 4], unit[k, 5])
        _set_row(model, matrix, k, times(work, HULL, ARTICULATED, v0, v1, v2, w0, w1, w2))
    return matrix


@inner
def _joint_row(model, work, i, matrix):
    """Row and column of joint i: the force of a unit acceleration, carried to the base."""
    b, c = ARTICULATED + COUPLING, ARTICULATED + ANGULAR
    f0, f1, f2 = work[i, b + 2], work[i, b + 5], work[i, b + 8]
    n0, n1, n2 = work[i, c + 2], work[i, c + 4], work[i, c + 5]
    matrix[5 + i, 5 + i] = n2 + model[i, ROTOR]
    for j in range(i, 0, -1):
        f0, f1, f2, n0, n1, n2 = force_to_parent(model, work, j, f0, f1, f2, n0, n1, n2)
        if j > 1:
            matrix[5 + i, 4 + j] = matrix[4 + j, 5 + i] = n2
    _set_row(model, matrix, 5 + i, (f0, f1, f2, n0, n1, n2))
    for k in range(6):
        matrix[k, 5 + i] = matrix[5 + i, k]


@inner
def _set_row(model, matrix, row, force):
    """First six columns of a row: a force on the hull, in body axes."""
    f0, f1, f2, n0, n1, n2 = force
    matrix[row, 0], matrix[row, 1], matrix[row, 2] = to_body(model, f0, f1, f2)
    matrix[row, 3], matrix[row, 4], matrix[row, 5] = to_body(model, n0, n1, n2)
