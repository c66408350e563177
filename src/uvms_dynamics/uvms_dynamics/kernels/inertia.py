"""Move a symmetric 6x6 inertia to the parent's frame, in scalars."""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import (
    ANGULAR,
    ARTICULATED,
    COS,
    COS_TWIST,
    COUPLING,
    INERTIA,
    INERTIA_NUMBERS,
    LINEAR,
    PLACE,
    SIN,
    SIN_TWIST,
)
from uvms_dynamics.kernels.spatial import cross, load, load3


@inner
def copy_inertia(model, work, i):
    """Start an articulated or composite inertia with the body's own."""
    for k in range(INERTIA_NUMBERS):
        work[i, ARTICULATED + k] = model[i, INERTIA + k]


@inner
def add_to_parent(model, work, i):
    """I[i-1] += X^T I[i] X with the articulated inertias of the workspace.

    First to the parent's axes, [A, B; B^T, C] with R A R^T and so on, then to its origin:
    [A, B'; B'^T, C'] with B' = B - A [p]x and C' = C - B^T [p]x + [p]x B'.
    """
    a00, a01, a02, a11, a12, a22 = _turned_symmetric(model, work, i, ARTICULATED + LINEAR)
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = _turned_coupling(model, work, i)
    c00, c01, c02, c11, c12, c22 = _turned_symmetric(model, work, i, ARTICULATED + ANGULAR)
    p0, p1, p2 = load3(model, i, PLACE)
    # rows of -A [p]x are p x (rows of A)
    d00, d01, d02 = cross(p0, p1, p2, a00, a01, a02)
    d10, d11, d12 = cross(p0, p1, p2, a01, a11, a12)
    d20, d21, d22 = cross(p0, p1, p2, a02, a12, a22)
    d00, d01, d02 = b00 + d00, b01 + d01, b02 + d02
    d10, d11, d12 = b10 + d10, b11 + d11, b12 + d12
    d20, d21, d22 = b20 + d20, b21 + d21, b22 + d22
    # rows of -B^T [p]x are p x (columns of B), columns of [p]x B' are p x (columns of B')
    c00 += p1 * (b20 + d20) - p2 * (b10 + d10)
    c11 += p2 * (b01 + d01) - p0 * (b21 + d21)
    c22 += p0 * (b12 + d12) - p1 * (b02 + d02)
    c01 += (p2 * b00 - p0 * b20) + (p1 * d21 - p2 * d11)
    c02 += (p0 * b10 - p1 * b00) + (p1 * d22 - p2 * d12)
    c12 += (p0 * b11 - p1 * b01) + (p2 * d02 - p0 * d22)
    _add6(work, i - 1, ARTICULATED + LINEAR, a00, a01, a02, a11, a12, a22)
    _add3(work, i - 1, ARTICULATED + COUPLING, d00, d01, d02)
    _add3(work, i - 1, ARTICULATED + COUPLING + 3, d10, d11, d12)
    _add3(work, i - 1, ARTICULATED + COUPLING + 6, d20, d21, d22)
    _add6(work, i - 1, ARTICULATED + ANGULAR, c00, c01, c02, c11, c12, c22)


@inner
def _turned_symmetric(model, work, i, k):
    """R S R^T of the diagonal block that starts at column k: first Rz(q), then Rx(twist)."""
    s00, s01, s02, s11, s12, s22 = load(work, i, k)
    c, s = work[i, COS], work[i, SIN]
    s00, s01, s11 = _turned_square(c, s, s00, s01, s11)
    s02, s12 = _turned_pair(c, s, s02, s12)
    c, s = model[i, COS_TWIST], model[i, SIN_TWIST]
    s11, s12, s22 = _turned_square(c, s, s11, s12, s22)
    s01, s02 = _turned_pair(c, s, s01, s02)
    return s00, s01, s02, s11, s12, s22


@inner
def _turned_coupling(model, work, i):
    """R B R^T of the coupling block."""
    b00, b01, b02 = load3(work, i, ARTICULATED + COUPLING)
    b10, b11, b12 = load3(work, i, ARTICULATED + COUPLING + 3)
    b20, b21, b22 = load3(work, i, ARTICULATED + COUPLING + 6)
    c, s = work[i, COS], work[i, SIN]
    b00, b01, b10, b11 = _turned_block(c, s, b00, b01, b10, b11)
    b02, b12 = _turned_pair(c, s, b02, b12)
    b20, b21 = _turned_pair(c, s, b20, b21)
    c, s = model[i, COS_TWIST], model[i, SIN_TWIST]
    b11, b12, b21, b22 = _turned_block(c, s, b11, b12, b21, b22)
    b01, b02 = _turned_pair(c, s, b01, b02)
    b10, b20 = _turned_pair(c, s, b10, b20)
    return b00, b01, b02, b10, b11, b12, b20, b21, b22


@inner
def _turned_pair(c, s, x, y):
    """A vector of the plane, turned."""
    return c * x - s * y, s * x + c * y


@inner
def _turned_square(c, s, x00, x01, x11):
    """A symmetric 2x2 block, turned: its mean stays, its deviator turns by twice the angle."""
    mean, half = 0.5 * (x00 + x11), 0.5 * (x00 - x11)
    half, x01 = _turned_pair(c * c - s * s, 2.0 * c * s, half, x01)
    return mean + half, x01, mean - half


@inner
def _turned_block(c, s, x00, x01, x10, x11):
    """Any 2x2 block, turned: its skew part stays."""
    skew = 0.5 * (x01 - x10)
    x00, x01, x11 = _turned_square(c, s, x00, 0.5 * (x01 + x10), x11)
    return x00, x01 + skew, x01 - skew, x11


@inner
def _add3(work, i, k, x0, x1, x2):
    work[i, k] += x0
    work[i, k + 1] += x1
    work[i, k + 2] += x2


@inner
def _add6(work, i, k, x0, x1, x2, x3, x4, x5):
    _add3(work, i, k, x0, x1, x2)
    _add3(work, i, k + 3, x3, x4, x5)
