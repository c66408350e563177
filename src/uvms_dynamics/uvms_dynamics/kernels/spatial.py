"""Spatial algebra in scalars: motions (v, omega), forces (f, n) and 6x6 inertias.

Everything is written out in scalars over flat tables, because numba then keeps the values in
registers; small matrix products with their temporaries were 17 times slower. A motion or a force
is six numbers, linear part first, about the origin of its frame; `i` is the row of its body.
Notation: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 2.
"""

import math

import numpy as np

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import (
    NET_MOMENT,
    NET_WEIGHT,
    OFFSET,
    ROTATION,
    TREE_POSITION,
    TREE_ROTATION,
)

_ROW_0, _ROW_1, _ROW_2, _ROW_3, _ROW_4, _ROW_5 = (np.int64(6 * row) for row in range(6))


@inner
def cross(a0, a1, a2, b0, b1, b2):
    """Vector product a x b."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


@inner
def load(table, i, k):
    """Six numbers of row i from column k on."""
    return (
        table[i, k],
        table[i, k + 1],
        table[i, k + 2],
        table[i, k + 3],
        table[i, k + 4],
        table[i, k + 5],
    )


@inner
def load3(table, i, k):
    """Three numbers of row i from column k on."""
    return table[i, k], table[i, k + 1], table[i, k + 2]


@inner
def store3(table, i, k, a0, a1, a2):
    """Write three numbers to row i from column k on."""
    table[i, k], table[i, k + 1], table[i, k + 2] = a0, a1, a2


@inner
def store(table, i, k, a0, a1, a2, a3, a4, a5):
    """Write six numbers to row i from column k on."""
    store3(table, i, k, a0, a1, a2)
    store3(table, i, k + 3, a3, a4, a5)


@inner
def add(table, i, k, a0, a1, a2, a3, a4, a5):
    """Add six numbers to row i from column k on."""
    table[i, k] += a0
    table[i, k + 1] += a1
    table[i, k + 2] += a2
    table[i, k + 3] += a3
    table[i, k + 4] += a4
    table[i, k + 5] += a5


@inner
def set_rotation(joints, work, i, angle):
    """Rotation of frame i to its parent: the joint's fixed rotation, then Rz(angle)."""
    turned = angle + joints[i, OFFSET]
    c, s = math.cos(turned), math.sin(turned)
    for row in range(3):
        x, y, z = load3(joints, i, TREE_ROTATION + 3 * row)
        store3(work, i, ROTATION + 3 * row, x * c + y * s, y * c - x * s, z)


@inner
def turn(work, i, x, y, z):
    """Components in the parent frame of a vector of frame i: R x."""
    return (
        work[i, ROTATION] * x + work[i, ROTATION + 1] * y + work[i, ROTATION + 2] * z,
        work[i, ROTATION + 3] * x + work[i, ROTATION + 4] * y + work[i, ROTATION + 5] * z,
        work[i, ROTATION + 6] * x + work[i, ROTATION + 7] * y + work[i, ROTATION + 8] * z,
    )


@inner
def turn_back(work, i, x, y, z):
    """Components in frame i of a vector of the parent frame: R^T x."""
    return (
        work[i, ROTATION] * x + work[i, ROTATION + 3] * y + work[i, ROTATION + 6] * z,
        work[i, ROTATION + 1] * x + work[i, ROTATION + 4] * y + work[i, ROTATION + 7] * z,
        work[i, ROTATION + 2] * x + work[i, ROTATION + 5] * y + work[i, ROTATION + 8] * z,
    )


@inner
def motion_to_child(joints, work, i, v0, v1, v2, w0, w1, w2):
    """Motion of the parent seen from frame i: (R^T (v + w x p), R^T w)."""
    p0, p1, p2 = load3(joints, i, TREE_POSITION)
    a0, a1, a2 = cross(w0, w1, w2, p0, p1, p2)
    u0, u1, u2 = turn_back(work, i, v0 + a0, v1 + a1, v2 + a2)
    x0, x1, x2 = turn_back(work, i, w0, w1, w2)
    return u0, u1, u2, x0, x1, x2


@inner
def force_to_parent(joints, work, i, f0, f1, f2, n0, n1, n2):
    """Force on frame i about the parent's origin: (R f, R n + p x R f)."""
    p0, p1, p2 = load3(joints, i, TREE_POSITION)
    g0, g1, g2 = turn(work, i, f0, f1, f2)
    m0, m1, m2 = turn(work, i, n0, n1, n2)
    c0, c1, c2 = cross(p0, p1, p2, g0, g1, g2)
    return g0, g1, g2, m0 + c0, m1 + c1, m2 + c2


@inner
def times(table, i, v0, v1, v2, w0, w1, w2):
    """Momentum I v, with the 6x6 inertia in the first 36 columns of row i."""
    return (
        _row(table, i, _ROW_0, v0, v1, v2, w0, w1, w2),
        _row(table, i, _ROW_1, v0, v1, v2, w0, w1, w2),
        _row(table, i, _ROW_2, v0, v1, v2, w0, w1, w2),
        _row(table, i, _ROW_3, v0, v1, v2, w0, w1, w2),
        _row(table, i, _ROW_4, v0, v1, v2, w0, w1, w2),
        _row(table, i, _ROW_5, v0, v1, v2, w0, w1, w2),
    )


@inner
def _row(table, i, k, v0, v1, v2, w0, w1, w2):
    a0, a1, a2, b0, b1, b2 = load(table, i, k)
    return a0 * v0 + a1 * v1 + a2 * v2 + b0 * w0 + b1 * w1 + b2 * w2


@inner
def gyroscopic(table, i, v0, v1, v2, w0, w1, w2):
    """Kirchhoff's C(v) v = (w x p, w x h + v x p) with the momentum (p, h) = I v of body i.

    With rigid and added mass in one symmetric I this is C_RB nu + C_A nu_r of section 2.2 in
    one: the momentum B = dT/dv of section 2.2.1, turning with the body.
    """
    p0, p1, p2, h0, h1, h2 = times(table, i, v0, v1, v2, w0, w1, w2)
    return turning_momentum(v0, v1, v2, w0, w1, w2, p0, p1, p2, h0, h1, h2)


@inner
def turning_momentum(v0, v1, v2, w0, w1, w2, p0, p1, p2, h0, h1, h2):
    """Rate of a momentum (p, h) that is constant in a frame moving with (v, w)."""
    f0, f1, f2 = cross(w0, w1, w2, p0, p1, p2)
    n0, n1, n2 = cross(w0, w1, w2, h0, h1, h2)
    m0, m1, m2 = cross(v0, v1, v2, p0, p1, p2)
    return f0, f1, f2, n0 + m0, n1 + m1, n2 + m2


@inner
def weight(bodies, i, k0, k1, k2):
    """Weight and buoyancy of body i as a force; (k0, k1, k2) points down in its frame."""
    w = bodies[i, NET_WEIGHT]
    p0, p1, p2 = load3(bodies, i, NET_MOMENT)
    n0, n1, n2 = cross(p0, p1, p2, k0, k1, k2)
    return w * k0, w * k1, w * k2, n0, n1, n2
