"""Move a general symmetric 6x6 inertia to the parent's frame, in scalars."""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.spatial import cross, turn


@inner
def add_to_parent(inertia, i, rotation, position, parent):
    """inertia[parent] += X^T inertia[i] X, X = [R^T, -R^T [p]x; 0, R^T] of joint frame i - 1.

    In blocks, I = [A, B; B^T, C] turned to the parent's axes becomes [A, B'; B'^T, C'] with
    B' = B - A [p]x and C' = C - B^T [p]x + [p]x B'. Only the upper triangles of the diagonal
    blocks are computed; the parent gets a full symmetric matrix.
    """
    frame = i - 1
    p0, p1, p2 = position[frame, 0], position[frame, 1], position[frame, 2]
    a00, a01, a02, a11, a12, a22 = _turned_symmetric(inertia, i, 0, rotation, frame)
    c00, c01, c02, c11, c12, c22 = _turned_symmetric(inertia, i, 3, rotation, frame)
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = _turned_coupling(inertia, i, rotation, frame)
    # rows of -A [p]x are p x (rows of A)
    d00, d01, d02 = cross(p0, p1, p2, a00, a01, a02)
    d10, d11, d12 = cross(p0, p1, p2, a01, a11, a12)
    d20, d21, d22 = cross(p0, p1, p2, a02, a12, a22)
    # rows of -B^T [p]x are p x (columns of B)
    e00, e01, e02 = cross(p0, p1, p2, b00, b10, b20)
    _, e11, e12 = cross(p0, p1, p2, b01, b11, b21)
    _, _, e22 = cross(p0, p1, p2, b02, b12, b22)
    b00, b01, b02 = b00 + d00, b01 + d01, b02 + d02
    b10, b11, b12 = b10 + d10, b11 + d11, b12 + d12
    b20, b21, b22 = b20 + d20, b21 + d21, b22 + d22
    # columns of [p]x B' are p x (columns of B')
    g00, _, _ = cross(p0, p1, p2, b00, b10, b20)
    g01, g11, _ = cross(p0, p1, p2, b01, b11, b21)
    g02, g12, g22 = cross(p0, p1, p2, b02, b12, b22)
    _add_symmetric(inertia, parent, 0, a00, a01, a02, a11, a12, a22)
    _add_symmetric(
        inertia,
        parent,
        3,
        c00 + e00 + g00,
        c01 + e01 + g01,
        c02 + e02 + g02,
        c11 + e11 + g11,
        c12 + e12 + g12,
        c22 + e22 + g22,
    )
    _add_coupling(inertia, parent, 0, b00, b01, b02)
    _add_coupling(inertia, parent, 1, b10, b11, b12)
    _add_coupling(inertia, parent, 2, b20, b21, b22)


@inner
def _turned_symmetric(inertia, i, k, rotation, frame):
    """Upper triangle of R S R^T of the diagonal block S that starts at row k."""
    s00, s01, s02 = inertia[i, k, k], inertia[i, k, k + 1], inertia[i, k, k + 2]
    s11, s12, s22 = inertia[i, k + 1, k + 1], inertia[i, k + 1, k + 2], inertia[i, k + 2, k + 2]
    x00, x10, x20 = turn(rotation, frame, s00, s01, s02)
    x01, x11, x21 = turn(rotation, frame, s01, s11, s12)
    x02, x12, x22 = turn(rotation, frame, s02, s12, s22)
    y00, y01, y02 = turn(rotation, frame, x00, x01, x02)
    _, y11, y12 = turn(rotation, frame, x10, x11, x12)
    _, _, y22 = turn(rotation, frame, x20, x21, x22)
    return y00, y01, y02, y11, y12, y22


@inner
def _turned_coupling(inertia, i, rotation, frame):
    """R B R^T of the upper right block B."""
    x00, x10, x20 = turn(rotation, frame, inertia[i, 0, 3], inertia[i, 1, 3], inertia[i, 2, 3])
    x01, x11, x21 = turn(rotation, frame, inertia[i, 0, 4], inertia[i, 1, 4], inertia[i, 2, 4])
    x02, x12, x22 = turn(rotation, frame, inertia[i, 0, 5], inertia[i, 1, 5], inertia[i, 2, 5])
    y00, y01, y02 = turn(rotation, frame, x00, x01, x02)
    y10, y11, y12 = turn(rotation, frame, x10, x11, x12)
    y20, y21, y22 = turn(rotation, frame, x20, x21, x22)
    return y00, y01, y02, y10, y11, y12, y20, y21, y22


@inner
def _add_symmetric(inertia, i, k, s00, s01, s02, s11, s12, s22):
    inertia[i, k, k] += s00
    inertia[i, k, k + 1] += s01
    inertia[i, k, k + 2] += s02
    inertia[i, k + 1, k] += s01
    inertia[i, k + 1, k + 1] += s11
    inertia[i, k + 1, k + 2] += s12
    inertia[i, k + 2, k] += s02
    inertia[i, k + 2, k + 1] += s12
    inertia[i, k + 2, k + 2] += s22


@inner
def _add_coupling(inertia, i, row, x, y, z):
    inertia[i, row, 3] += x
    inertia[i, row, 4] += y
    inertia[i, row, 5] += z
    inertia[i, 3, row] += x
    inertia[i, 4, row] += y
    inertia[i, 5, row] += z
