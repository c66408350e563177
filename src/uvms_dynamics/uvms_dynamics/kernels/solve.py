"""Solve for the acceleration of a free body with a symmetric 6x6 inertia."""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import ANGULAR, ARTICULATED, COUPLING, LINEAR
from uvms_dynamics.kernels.spatial import load, load3


@inner
def solve_inertia(work, i, f0, f1, f2, n0, n1, n2):
    """Motion (v, w) with I (v, w) = (f, n), I = [A, B; B^T, C] the articulated inertia of row i.

    By blocks: with X = A^-1 B the Schur complement S = C - B^T X gives w = S^-1 (n - X^T f) and
    v = A^-1 f - X w. Each block has one unit and is well conditioned, so that adjugates, one
    division each, are as exact as a factorization and leave the processor no chain to wait for.
    """
    b00, b01, b02 = load3(work, i, ARTICULATED + COUPLING)
    b10, b11, b12 = load3(work, i, ARTICULATED + COUPLING + 3)
    b20, b21, b22 = load3(work, i, ARTICULATED + COUPLING + 6)
    i00, i01, i02, i11, i12, i22 = _inverse(load(work, i, ARTICULATED + LINEAR))
    x00, x10, x20 = _product(i00, i01, i02, i11, i12, i22, b00, b10, b20)
    x01, x11, x21 = _product(i00, i01, i02, i11, i12, i22, b01, b11, b21)
    x02, x12, x22 = _product(i00, i01, i02, i11, i12, i22, b02, b12, b22)
    y0, y1, y2 = _product(i00, i01, i02, i11, i12, i22, f0, f1, f2)
    c00, c01, c02, c11, c12, c22 = load(work, i, ARTICULATED + ANGULAR)
    c00 -= b00 * x00 + b10 * x10 + b20 * x20
    c01 -= b00 * x01 + b10 * x11 + b20 * x21
    c02 -= b00 * x02 + b10 * x12 + b20 * x22
    c11 -= b01 * x01 + b11 * x11 + b21 * x21
    c12 -= b01 * x02 + b11 * x12 + b21 * x22
    c22 -= b02 * x02 + b12 * x12 + b22 * x22
    n0 -= x00 * f0 + x10 * f1 + x20 * f2
    n1 -= x01 * f0 + x11 * f1 + x21 * f2
    n2 -= x02 * f0 + x12 * f1 + x22 * f2
    i00, i01, i02, i11, i12, i22 = _inverse((c00, c01, c02, c11, c12, c22))
    w0, w1, w2 = _product(i00, i01, i02, i11, i12, i22, n0, n1, n2)
    v0 = y0 - (x00 * w0 + x01 * w1 + x02 * w2)
    v1 = y1 - (x10 * w0 + x11 * w1 + x12 * w2)
    v2 = y2 - (x20 * w0 + x21 * w1 + x22 * w2)
    return v0, v1, v2, w0, w1, w2


@inner
def _inverse(matrix):
    """Inverse of a symmetric 3x3 matrix, upper triangles row by row."""
    a00, a01, a02, a11, a12, a22 = matrix
    m00, m01, m02 = a11 * a22 - a12 * a12, a02 * a12 - a01 * a22, a01 * a12 - a02 * a11
    m11, m12, m22 = a00 * a22 - a02 * a02, a01 * a02 - a00 * a12, a00 * a11 - a01 * a01
    scale = 1.0 / (a00 * m00 + a01 * m01 + a02 * m02)
    return scale * m00, scale * m01, scale * m02, scale * m11, scale * m12, scale * m22


@inner
def _product(s00, s01, s02, s11, s12, s22, x, y, z):
    """Symmetric 3x3 matrix times vector."""
    return s00 * x + s01 * y + s02 * z, s01 * x + s11 * y + s12 * z, s02 * x + s12 * y + s22 * z
