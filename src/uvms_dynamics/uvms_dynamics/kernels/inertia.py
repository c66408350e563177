"""Move a general symmetric 6x6 inertia to the parent's frame, in scalars."""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import ANGULAR_BLOCK, LINEAR_BLOCK, TREE_POSITION
from uvms_dynamics.kernels.spatial import cross, load3, turn


@inner
def copy_inertia(bodies, work, i):
    """Start an articulated or composite inertia with the body's own."""
    for k in range(36):
        work[i, k] = bodies[i, k]


@inner
def add_to_parent(joints, work, i):
    """I[i-1] += X^T I[i] X, X = [R^T, -R^T [p]x; 0, R^T], inertias in the workspace.

    In blocks, I = [A, B; B^T, C] turned to the parent's axes becomes [A, B'; B'^T, C'] with
    B' = B - A [p]x and C' = C - B^T [p]x + [p]x B'. Only the upper triangles of the diagonal
    blocks are computed; the parent gets a full symmetric matrix.
    """
    p0, p1, p2 = load3(joints, i, TREE_POSITION)
    a00, a01, a02, a11, a12, a22 = _turned_symmetric(work, i, LINEAR_BLOCK)
    c00, c01, c02, c11, c12, c22 = _turned_symmetric(work, i, ANGULAR_BLOCK)
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = _turned_coupling(work, i)
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
    c00, c01, c02 = c00 + e00 + g00, c01 + e01 + g01, c02 + e02 + g02
    c11, c12, c22 = c11 + e11 + g11, c12 + e12 + g12, c22 + e22 + g22
    _add_symmetric(work, i - 1, LINEAR_BLOCK, a00, a01, a02, a11, a12, a22)
    _add_symmetric(work, i - 1, ANGULAR_BLOCK, c00, c01, c02, c11, c12, c22)
    _add_coupling(work, i - 1, b00, b01, b02, b10, b11, b12, b20, b21, b22)


@inner
def _turned_symmetric(work, i, k):
    """Upper triangle of R S R^T of the diagonal block S that starts at column k."""
    s00, s01, s02 = work[i, k], work[i, k + 1], work[i, k + 2]
    s11, s12, s22 = work[i, k + 7], work[i, k + 8], work[i, k + 14]
    x00, x10, x20 = turn(work, i, s00, s01, s02)
    x01, x11, x21 = turn(work, i, s01, s11, s12)
    x02, x12, x22 = turn(work, i, s02, s12, s22)
    y00, y01, y02 = turn(work, i, x00, x01, x02)
    _, y11, y12 = turn(work, i, x10, x11, x12)
    _, _, y22 = turn(work, i, x20, x21, x22)
    return y00, y01, y02, y11, y12, y22


@inner
def _turned_coupling(work, i):
    """R B R^T of the upper right block B."""
    x00, x10, x20 = turn(work, i, work[i, 3], work[i, 9], work[i, 15])
    x01, x11, x21 = turn(work, i, work[i, 4], work[i, 10], work[i, 16])
    x02, x12, x22 = turn(work, i, work[i, 5], work[i, 11], work[i, 17])
    y00, y01, y02 = turn(work, i, x00, x01, x02)
    y10, y11, y12 = turn(work, i, x10, x11, x12)
    y20, y21, y22 = turn(work, i, x20, x21, x22)
    return y00, y01, y02, y10, y11, y12, y20, y21, y22


@inner
def _add_symmetric(work, i, k, s00, s01, s02, s11, s12, s22):
    work[i, k] += s00
    work[i, k + 1] += s01
    work[i, k + 2] += s02
    work[i, k + 6] += s01
    work[i, k + 7] += s11
    work[i, k + 8] += s12
    work[i, k + 12] += s02
    work[i, k + 13] += s12
    work[i, k + 14] += s22


@inner
def _add_coupling(work, i, b00, b01, b02, b10, b11, b12, b20, b21, b22):
    """Add B to the upper right block and B^T to the lower left one."""
    row = work[i]
    row[3], row[4], row[5] = row[3] + b00, row[4] + b01, row[5] + b02
    row[9], row[10], row[11] = row[9] + b10, row[10] + b11, row[11] + b12
    row[15], row[16], row[17] = row[15] + b20, row[16] + b21, row[17] + b22
    row[18], row[19], row[20] = row[18] + b00, row[19] + b10, row[20] + b20
    row[24], row[25], row[26] = row[24] + b01, row[25] + b11, row[26] + b21
    row[30], row[31], row[32] = row[30] + b02, row[31] + b12, row[32] + b22
