"""Mass matrix of the whole system by composite bodies."""

import numpy as np

from uvms_dynamics.kernels.chain import joint_rotations
from uvms_dynamics.kernels.inertia import add_to_parent
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.spatial import force_to_parent


@kernel
def mass_matrix(model, q):
    """M(q) (6+n, 6+n): rigid bodies, added mass and rotors; symmetric positive definite.

    Rows and columns: body wrench and nu_r_dot, then joint torques and q_ddot; q (n,) rad.
    Composite-rigid-body algorithm (Featherstone 2008, sec. 6.2) with a general symmetric inertia.
    """
    n = q.shape[0]
    rotation = np.empty((n, 3, 3))
    joint_rotations(model, q, rotation)
    composite = model.inertia.copy()
    matrix = np.empty((6 + n, 6 + n))
    for i in range(n, 0, -1):
        _joint_row(model, i, rotation, composite, matrix)
        add_to_parent(composite, i, rotation, model.tree_position, i - 1)
    for row in range(6):
        for column in range(6):
            matrix[row, column] = composite[0, row, column]
    return matrix


@inner
def _joint_row(model, i, rotation, composite, matrix):
    """Row and column of joint i: the force of a unit acceleration, carried to the base."""
    f0, f1, f2 = composite[i, 0, 5], composite[i, 1, 5], composite[i, 2, 5]
    n0, n1, n2 = composite[i, 3, 5], composite[i, 4, 5], composite[i, 5, 5]
    matrix[5 + i, 5 + i] = n2 + model.rotor_inertia[i - 1]
    for j in range(i - 1, -1, -1):
        f0, f1, f2, n0, n1, n2 = force_to_parent(
            rotation, model.tree_position, j, f0, f1, f2, n0, n1, n2
        )
        if j > 0:
            matrix[5 + i, 5 + j] = matrix[5 + j, 5 + i] = n2
    column = (f0, f1, f2, n0, n1, n2)
    for k in range(6):
        matrix[k, 5 + i] = matrix[5 + i, k] = column[k]
