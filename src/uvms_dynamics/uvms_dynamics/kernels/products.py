"""Products whose sums run in a fixed order, so that runs repeat bit for bit.

A BLAS library may sum in another order where its operands lie elsewhere in memory.
"""

import numpy as np

from uvms_dynamics.kernels.jit import exact_inner


@exact_inner
def product(matrix, vector):
    """Matrix (m, n) times vector (n,)."""
    out = np.empty(matrix.shape[0])
    for i in range(matrix.shape[0]):
        total = 0.0
        for k in range(matrix.shape[1]):
            total += matrix[i, k] * vector[k]
        out[i] = total
    return out


@exact_inner
def transposed_product(matrix, vector):
    """The transpose of a matrix (m, n) times vector (m,)."""
    out = np.empty(matrix.shape[1])
    for i in range(matrix.shape[1]):
        total = 0.0
        for k in range(matrix.shape[0]):
            total += matrix[k, i] * vector[k]
        out[i] = total
    return out


@exact_inner
def inner_product(one, other):
    """Of two vectors (n,)."""
    total = 0.0
    for i in range(one.shape[0]):
        total += one[i] * other[i]
    return total


@exact_inner
def squared(matrix):
    """A square matrix (n, n) times itself."""
    n = matrix.shape[0]
    out = np.empty((n, n))
    for i in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += matrix[i, k] * matrix[k, j]
            out[i, j] = total
    return out
