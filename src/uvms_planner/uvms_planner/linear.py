"""Small dense algebra for kernels, without temporaries.

Copies are written as loops: the errors that a slice assignment may raise cost seconds to compile.
"""

from uvms_dynamics.kernels.jit import inner, shared


@shared
def solve_in_place(a, b, size):
    """Solve a x = b for the leading `size` rows by Gaussian elimination with partial pivoting.

    `a` (>= size, >= size) is overwritten and `b` (>= size,) becomes x. Returns False, with `b`
    unusable, where `a` is singular.
    """
    for k in range(size):
        pivot = k
        for i in range(k + 1, size):
            if abs(a[i, k]) > abs(a[pivot, k]):
                pivot = i
        if abs(a[pivot, k]) < 1e-300:
            return False
        if pivot != k:
            for j in range(k, size):
                a[k, j], a[pivot, j] = a[pivot, j], a[k, j]
            b[k], b[pivot] = b[pivot], b[k]
        for i in range(k + 1, size):
            factor = a[i, k] / a[k, k]
            if factor != 0.0:
                for j in range(k + 1, size):
                    a[i, j] -= factor * a[k, j]
                b[i] -= factor * b[k]
    for k in range(size - 1, -1, -1):
        total = b[k]
        for j in range(k + 1, size):
            total -= a[k, j] * b[j]
        b[k] = total / a[k, k]
    return True


@inner
def copy_into(out, values):
    """out[:] = values, both (k,)."""
    for i in range(out.shape[0]):
        out[i] = values[i]
