"""Mass matrix of the whole system by composite bodies."""

import numpy as np

from uvms_dynamics.kernels.inertia import (
    axis_force,
    inertia_to_parent,
    load_inertia,
    plus_inertia,
)
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import HULL, INERTIA, ROTOR
from uvms_dynamics.kernels.motion import (
    check_joints,
    into_body,
    into_hull,
    make_workspace,
    set_angle,
)
from uvms_dynamics.kernels.spatial import force_to_parent, load6, times


@kernel
def mass_matrix(model, q):
    """M(q) (6+n, 6+n): rigid bodies, added mass and rotors; symmetric positive definite.

    Rows and columns: body wrench and nu_r_dot, then joint torques and q_ddot; q (n,) rad.
    Composite-rigid-body algorithm (Featherstone 2008, sec. 6.2) with a general symmetric inertia.
    """
    check_joints(model, q, q, q)
    n = q.shape[0]
    work, matrix = make_workspace(model), np.empty((6 + n, 6 + n))
    zero = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    inertia = zero + zero + zero + (0.0, 0.0, 0.0)
    for i in range(1, n + 1):
        set_angle(model, work, i, q[i - 1])
    for i in range(n, 0, -1):
        inertia = plus_inertia(load_inertia(model, i, INERTIA), inertia)
        _set_joint_row(model, work, i, axis_force(inertia), matrix)
        inertia = inertia_to_parent(model, work, i, inertia)
    inertia = plus_inertia(load_inertia(model, HULL, INERTIA), inertia)
    unit = np.eye(6)
    for k in range(6):
        force = times(inertia, into_hull(model, load6(unit, k, 0)))
        _set_hull_columns(model, matrix, k, force)
        for j in range(k):  # symmetric to the last bit
            matrix[k, j] = matrix[j, k]
    return matrix


@inner
def _set_joint_row(model, work, i, force, matrix):
    """Row and column of joint i: the force of a unit acceleration, carried to the base."""
    matrix[5 + i, 5 + i] = force[5] + model[i, ROTOR]
    for j in range(i, 0, -1):
        force = force_to_parent(model, work, j, force)
        if j > 1:
            matrix[5 + i, 4 + j] = matrix[4 + j, 5 + i] = force[5]
    _set_hull_columns(model, matrix, 5 + i, force)
    for k in range(6):
        matrix[k, 5 + i] = matrix[5 + i, k]


@inner
def _set_hull_columns(model, matrix, row, force):
    """First six columns of a row: a force on the hull, in body axes."""
    force = into_body(model, force)
    for k in range(6):
        matrix[row, k] = force[k]
