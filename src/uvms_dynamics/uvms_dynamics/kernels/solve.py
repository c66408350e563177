"""Solve a symmetric positive definite system of six equations."""

from uvms_dynamics.kernels.jit import inner


@inner
def solve_symmetric(table, x):
    """Replace x[:6] by A^-1 x[:6], A = table[0] (6, 6), by its L D L^T; A is overwritten."""
    for j in range(6):
        for k in range(j):
            scaled = table[0, j, k] * table[0, k, k]
            for i in range(j, 6):
                table[0, i, j] -= table[0, i, k] * scaled
        inverse = 1.0 / table[0, j, j]
        for i in range(j + 1, 6):
            table[0, i, j] *= inverse
    for i in range(6):
        for k in range(i):
            x[i] -= table[0, i, k] * x[k]
    for i in range(5, -1, -1):
        x[i] /= table[0, i, i]
        for k in range(i + 1, 6):
            x[i] -= table[0, k, i] * x[k]
