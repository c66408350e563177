"""Spatial algebra in scalars: motions (v, omega), forces (f, n) and symmetric 6x6 inertias.

Everything is written out in scalars over flat tables, because numba then keeps the values in
registers; small matrix products with their temporaries were 17 times slower. A motion or a force
is six numbers, linear part first, about the origin of its frame; `i` is the row of its body.
Notation: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 2.

Every joint turns about the z axis of its frame, which lies in the parent's at Tr(p) Rx(twist); any
chain can be written so (`uvms_dynamics.model`), and two turns in a plane cost less than one in
space.
"""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import (
    ANGULAR,
    COS,
    COS_TWIST,
    COUPLING,
    NET_MOMENT,
    NET_WEIGHT,
    PLACE,
    SIN,
    SIN_TWIST,
)


@inner
def cross(a0, a1, a2, b0, b1, b2):
    """Vector product a x b."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


@inner
def load3(table, i, k):
    """Three numbers of row i from column k on."""
    return table[i, k], table[i, k + 1], table[i, k + 2]


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
def to_parent(model, work, i, x, y, z):
    """Components in the parent frame of a vector of frame i: Rx(twist) Rz(q) v."""
    c, s = work[i, COS], work[i, SIN]
    x, y = c * x - s * y, s * x + c * y
    c, s = model[i, COS_TWIST], model[i, SIN_TWIST]
    return x, c * y - s * z, s * y + c * z


@inner
def to_child(model, work, i, x, y, z):
    """Components in frame i of a vector of the parent frame."""
    c, s = model[i, COS_TWIST], model[i, SIN_TWIST]
    y, z = c * y + s * z, c * z - s * y
    c, s = work[i, COS], work[i, SIN]
    return c * x + s * y, c * y - s * x, z


@inner
def motion_to_child(model, work, i, v0, v1, v2, w0, w1, w2):
    """Motion of the parent seen from frame i: (R^T (v + w x p), R^T w)."""
    p0, p1, p2 = load3(model, i, PLACE)
    a0, a1, a2 = cross(w0, w1, w2, p0, p1, p2)
    u0, u1, u2 = to_child(model, work, i, v0 + a0, v1 + a1, v2 + a2)
    x0, x1, x2 = to_child(model, work, i, w0, w1, w2)
    return u0, u1, u2, x0, x1, x2


@inner
def force_to_parent(model, work, i, f0, f1, f2, n0, n1, n2):
    """Force on frame i about the parent's origin: (R f, R n + p x R f)."""
    p0, p1, p2 = load3(model, i, PLACE)
    g0, g1, g2 = to_parent(model, work, i, f0, f1, f2)
    m0, m1, m2 = to_parent(model, work, i, n0, n1, n2)
    c0, c1, c2 = cross(p0, p1, p2, g0, g1, g2)
    return g0, g1, g2, m0 + c0, m1 + c1, m2 + c2


@inner
def times(table, i, k, v0, v1, v2, w0, w1, w2):
    """Momentum (p, h) = I v of the inertia in row i from column k on."""
    a00, a01, a02, a11, a12, a22 = load(table, i, k)
    b00, b01, b02 = load3(table, i, k + COUPLING)
    b10, b11, b12 = load3(table, i, k + COUPLING + 3)
    b20, b21, b22 = load3(table, i, k + COUPLING + 6)
    c00, c01, c02, c11, c12, c22 = load(table, i, k + ANGULAR)
    return (
        a00 * v0 + a01 * v1 + a02 * v2 + (b00 * w0 + b01 * w1 + b02 * w2),
        a01 * v0 + a11 * v1 + a12 * v2 + (b10 * w0 + b11 * w1 + b12 * w2),
        a02 * v0 + a12 * v1 + a22 * v2 + (b20 * w0 + b21 * w1 + b22 * w2),
        b00 * v0 + b10 * v1 + b20 * v2 + (c00 * w0 + c01 * w1 + c02 * w2),
        b01 * v0 + b11 * v1 + b21 * v2 + (c01 * w0 + c11 * w1 + c12 * w2),
        b02 * v0 + b12 * v1 + b22 * v2 + (c02 * w0 + c12 * w1 + c22 * w2),
    )


@inner
def gyroscopic(table, i, k, v0, v1, v2, w0, w1, w2):
    """Kirchhoff's C(v) v = (w x p, w x h + v x p) with the momentum (p, h) = I v of body i.

    With rigid and added mass in one symmetric I this is C_RB nu + C_A nu_r of section 2.2 in
    one: the momentum B = dT/dv of section 2.2.1, turning with the body.
    """
    p0, p1, p2, h0, h1, h2 = times(table, i, k, v0, v1, v2, w0, w1, w2)
    f0, f1, f2 = cross(w0, w1, w2, p0, p1, p2)
    n0, n1, n2 = cross(w0, w1, w2, h0, h1, h2)
    m0, m1, m2 = cross(v0, v1, v2, p0, p1, p2)
    return f0, f1, f2, n0 + m0, n1 + m1, n2 + m2


@inner
def weight(model, i, k0, k1, k2):
    """Weight and buoyancy of body i as a force; (k0, k1, k2) points down in its frame."""
    w = model[i, NET_WEIGHT]
    p0, p1, p2 = load3(model, i, NET_MOMENT)
    n0, n1, n2 = cross(p0, p1, p2, k0, k1, k2)
    return w * k0, w * k1, w * k2, n0, n1, n2
