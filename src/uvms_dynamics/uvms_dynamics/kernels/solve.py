"""Solve a symmetric positive definite system of six equations."""

from uvms_dynamics.kernels.jit import inner


@inner
def solve_symmetric(work, x):
    """Replace x[:6] by A^-1 x[:6], A (6, 6) in row 0 of the table, by its L D L^T.

    A is overwritten.
    """
    for j in range(6):
        for k in range(j):
            scaled = work[0, 6 * j + k] * work[0, 7 * k]
            for i in range(j, 6):
                work[0, 6 * i + j] -= work[0, 6 * i + k] * scaled
        inverse = 1.0 / work[0, 7 * j]
        for i in range(j + 1, 6):
            work[0, 6 * i + j] *= inverse
    for i in range(6):
        for k in range(i):
            x[i] -= work[0, 6 * i + k] * x[k]
    for i in range(5, -1, -1):
        x[i] /= work[0, 7 * i]
        for k in range(i + 1, 6):
            x[i] -= work[0, 6 * k + i] * x[k]
