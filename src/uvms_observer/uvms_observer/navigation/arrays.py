"""Small steps that the filter's kernels share.

They are loops: numba takes seconds to compile what numpy's slices, broadcasts and copies may raise.
"""

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner
from uvms_observer.navigation.state import SIZE, NavigationState


@exact_inner
def transposed(matrix: Array) -> Array:
    """The transpose, contiguous in memory."""
    out = np.empty((matrix.shape[1], matrix.shape[0]))
    for i in range(matrix.shape[0]):
        for j in range(matrix.shape[1]):
            out[j, i] = matrix[i, j]
    return out


@exact_inner
def body_rate(state: NavigationState, rate: Array) -> Array:
    """The gyro's rate (3,) without its estimated bias."""
    omega = np.empty(3)
    for i in range(3):
        omega[i] = rate[i] - state.gyro_bias[i]
    return omega


@exact_inner
def subtract_from(measured: Array, expected: Array) -> None:
    """The expected reading (3,) becomes the residual."""
    for i in range(3):
        expected[i] = measured[i] - expected[i]


@exact_inner
def product(A: Array, B: Array) -> Array:
    """A B, (m, k) times (k, n), for an A with many zeros: row by row, as vector instructions."""
    out = np.zeros((A.shape[0], B.shape[1]))
    for i in range(A.shape[0]):
        for k in range(A.shape[1]):
            factor = A[i, k]
            if factor != 0.0:
                for j in range(B.shape[1]):
                    out[i, j] += factor * B[k, j]
    return out


@exact_inner
def subtract_products(P: Array, A: Array, B: Array) -> None:
    """P <- P - A^T B, in place, with A (m, SIZE) and B (m, SIZE): three rows at a time."""
    m = A.shape[0]
    for a in range(0, m - 2, 3):
        for i in range(SIZE):
            x, y, z = A[a, i], A[a + 1, i], A[a + 2, i]
            for j in range(SIZE):
                P[i, j] = P[i, j] - x * B[a, j] - y * B[a + 1, j] - z * B[a + 2, j]
    for a in range(m - m % 3, m):
        for i in range(SIZE):
            for j in range(SIZE):
                P[i, j] -= A[a, i] * B[a, j]


@exact_inner
def covariance_of(HP: Array, H: Array, N: Array) -> Array:
    """S = H P H^T + N, (m, m), of H P (m, SIZE)."""
    m = N.shape[0]
    S = np.empty((m, m))
    for i in range(m):
        for j in range(m):
            S[i, j] = N[i, j]
    for j in range(m):
        for k in range(SIZE):
            if H[j, k] != 0.0:
                for i in range(m):
                    S[i, j] += HP[i, k] * H[j, k]
    return S
