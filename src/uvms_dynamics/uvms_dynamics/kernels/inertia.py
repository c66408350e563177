"""Symmetric 6x6 inertias in 21 numbers: load, add, move to the parent's frame, solve."""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import COS, COS_TWIST, PLACE, SIN, SIN_TWIST
from uvms_dynamics.kernels.spatial import cross, load3, load6, turned


@inner
def load_inertia(table, i, k):
    """Inertia in row i from column k on."""
    return (
        load6(table, i, k)
        + load3(table, i, k + 6)
        + load3(table, i, k + 9)
        + load3(table, i, k + 12)
        + load6(table, i, k + 15)
    )


@inner
def plus_inertia(a, b):
    """Sum of two inertias."""
    return (
        a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5],
        a[6] + b[6], a[7] + b[7], a[8] + b[8], a[9] + b[9], a[10] + b[10], a[11] + b[11],
        a[12] + b[12], a[13] + b[13], a[14] + b[14], a[15] + b[15], a[16] + b[16], a[17] + b[17],
        a[18] + b[18], a[19] + b[19], a[20] + b[20],
    )  # fmt: skip


@inner
def axis_force(inertia):
    """U = I S (6,): the force of a unit turn about z, the last column."""
    return inertia[8], inertia[11], inertia[14], inertia[17], inertia[19], inertia[20]


@inner
def articulated_inertia(inertia, u, inverse):
    """I - U U^T / D: what is left of an inertia whose body is free to turn about z."""
    s0, s1, s2 = inverse * u[0], inverse * u[1], inverse * u[2]
    s3, s4, s5 = inverse * u[3], inverse * u[4], inverse * u[5]
    i = inertia
    return (
        i[0] - s0 * u[0], i[1] - s0 * u[1], i[2] - s0 * u[2],
        i[3] - s1 * u[1], i[4] - s1 * u[2], i[5] - s2 * u[2],
        i[6] - s0 * u[3], i[7] - s0 * u[4], i[8] - s0 * u[5],
        i[9] - s1 * u[3], i[10] - s1 * u[4], i[11] - s1 * u[5],
        i[12] - s2 * u[3], i[13] - s2 * u[4], i[14] - s2 * u[5],
        i[15] - s3 * u[3], i[16] - s3 * u[4], i[17] - s3 * u[5],
        i[18] - s4 * u[4], i[19] - s4 * u[5], i[20] - s5 * u[5],
    )  # fmt: skip


@inner
def inertia_to_parent(model, work, i, inertia):
    """Inertia of frame i about the parent's origin, in its axes: X^T I X.

    First to the parent's axes, [A, B; B^T, C] with R A R^T and so on, then to its origin:
    [A, B'; B'^T, C'] with B' = B - A [p]x and C' = C - B^T [p]x + [p]x B'.
    """
    a = _turned_symmetric(model, work, i, inertia[:6])
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = _turned_coupling(model, work, i, inertia[6:15])
    c00, c01, c02, c11, c12, c22 = _turned_symmetric(model, work, i, inertia[15:])
    p = load3(model, i, PLACE)
    # rows of -A [p]x are p x (rows of A)
    d00, d01, d02 = cross(p, (a[0], a[1], a[2]))
    d10, d11, d12 = cross(p, (a[1], a[3], a[4]))
    d20, d21, d22 = cross(p, (a[2], a[4], a[5]))
    d00, d01, d02 = b00 + d00, b01 + d01, b02 + d02
    d10, d11, d12 = b10 + d10, b11 + d11, b12 + d12
    d20, d21, d22 = b20 + d20, b21 + d21, b22 + d22
    # rows of -B^T [p]x are p x (columns of B), columns of [p]x B' are p x (columns of B')
    p0, p1, p2 = p
    c00 += p1 * (b20 + d20) - p2 * (b10 + d10)
    c11 += p2 * (b01 + d01) - p0 * (b21 + d21)
    c22 += p0 * (b12 + d12) - p1 * (b02 + d02)
    c01 += (p2 * b00 - p0 * b20) + (p1 * d21 - p2 * d11)
    c02 += (p0 * b10 - p1 * b00) + (p1 * d22 - p2 * d12)
    c12 += (p0 * b11 - p1 * b01) + (p2 * d02 - p0 * d22)
    return (
        *a,
        d00, d01, d02, d10, d11, d12, d20, d21, d22,
        c00, c01, c02, c11, c12, c22,
    )  # fmt: skip


@inner
def _turned_symmetric(model, work, i, block):
    """R S R^T of a diagonal block: first Rz(q), then Rx(twist)."""
    s00, s01, s02, s11, s12, s22 = block
    c, s = work[i, COS], work[i, SIN]
    s00, s01, s11 = _turned_square(c, s, s00, s01, s11)
    s02, s12 = turned(c, s, s02, s12)
    c, s = model[i, COS_TWIST], model[i, SIN_TWIST]
    s11, s12, s22 = _turned_square(c, s, s11, s12, s22)
    s01, s02 = turned(c, s, s01, s02)
    return s00, s01, s02, s11, s12, s22


@inner
def _turned_coupling(model, work, i, block):
    """R B R^T of the coupling block."""
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = block
    c, s = work[i, COS], work[i, SIN]
    b00, b01, b10, b11 = _turned_block(c, s, b00, b01, b10, b11)
    b02, b12 = turned(c, s, b02, b12)
    b20, b21 = turned(c, s, b20, b21)
    c, s = model[i, COS_TWIST], model[i, SIN_TWIST]
    b11, b12, b21, b22 = _turned_block(c, s, b11, b12, b21, b22)
    b01, b02 = turned(c, s, b01, b02)
    b10, b20 = turned(c, s, b10, b20)
    return b00, b01, b02, b10, b11, b12, b20, b21, b22


@inner
def _turned_square(c, s, x00, x01, x11):
    """A symmetric 2x2 block, turned: its mean stays, its deviator turns by twice the angle."""
    mean, half = 0.5 * (x00 + x11), 0.5 * (x00 - x11)
    half, x01 = turned(c * c - s * s, 2.0 * c * s, half, x01)
    return mean + half, x01, mean - half


@inner
def _turned_block(c, s, x00, x01, x10, x11):
    """Any 2x2 block, turned: its skew part stays."""
    skew = 0.5 * (x01 - x10)
    x00, x01, x11 = _turned_square(c, s, x00, 0.5 * (x01 + x10), x11)
    return x00, x01 + skew, x01 - skew, x11


@inner
def solve_inertia(inertia, force):
    """Motion (v, w) with I (v, w) = (f, n).

    By blocks: with X = A^-1 B the Schur complement S = C - B^T X gives w = S^-1 (n - X^T f) and
    v = A^-1 f - X w. Each block has one unit.
    """
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = inertia[6:15]
    c00, c01, c02, c11, c12, c22 = inertia[15:]
    f0, f1, f2, n0, n1, n2 = force
    a = _inverse(inertia[:6])
    x00, x10, x20 = _product(a, b00, b10, b20)
    x01, x11, x21 = _product(a, b01, b11, b21)
    x02, x12, x22 = _product(a, b02, b12, b22)
    y0, y1, y2 = _product(a, f0, f1, f2)
    c00 -= b00 * x00 + b10 * x10 + b20 * x20
    c01 -= b00 * x01 + b10 * x11 + b20 * x21
    c02 -= b00 * x02 + b10 * x12 + b20 * x22
    c11 -= b01 * x01 + b11 * x11 + b21 * x21
    c12 -= b01 * x02 + b11 * x12 + b21 * x22
    c22 -= b02 * x02 + b12 * x12 + b22 * x22
    n0 -= x00 * f0 + x10 * f1 + x20 * f2
    n1 -= x01 * f0 + x11 * f1 + x21 * f2
    n2 -= x02 * f0 + x12 * f1 + x22 * f2
    w0, w1, w2 = _product(_inverse((c00, c01, c02, c11, c12, c22)), n0, n1, n2)
    v0 = y0 - (x00 * w0 + x01 * w1 + x02 * w2)
    v1 = y1 - (x10 * w0 + x11 * w1 + x12 * w2)
    v2 = y2 - (x20 * w0 + x21 * w1 + x22 * w2)
    return v0, v1, v2, w0, w1, w2


@inner
def _inverse(block):
    """Inverse of a symmetric positive definite 3x3 matrix by L D L^T; upper triangles, row by row.

    The adjugate is shorter, but where one direction far outweighs the others, as in a plate's
    added mass is, its determinant loses the square of their ratio.
    """
    a00, a01, a02, a11, a12, a22 = block
    d0 = 1.0 / a00
    l10, l20 = a01 * d0, a02 * d0
    b12 = a12 - l10 * a02
    d1 = 1.0 / (a11 - l10 * a01)
    l21 = b12 * d1
    d2 = 1.0 / ((a22 - l20 * a02) - l21 * b12)
    k = l10 * l21 - l20
    kd, ld = k * d2, l21 * d2
    return d0 + (l10 * (l10 * d1) + k * kd), -l10 * d1 - l21 * kd, kd, d1 + l21 * ld, -ld, d2


@inner
def _product(block, x, y, z):
    """Symmetric 3x3 matrix times vector."""
    s00, s01, s02, s11, s12, s22 = block
    return s00 * x + s01 * y + s02 * z, s01 * x + s11 * y + s12 * z, s02 * x + s12 * y + s22 * z
