"""Spatial algebra in scalars: motions (v, omega), forces (f, n) and 6x6 inertias.

Everything is written out in scalars over flat tables, because numba then keeps the values in
registers; small matrix products with their temporaries were 17 times slower. A motion or a force
is six numbers, linear part first, about the origin of its frame. Tables hold one frame or body per
row; `i` picks the row. Notation: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 2.
"""

import math

from uvms_dynamics.kernels.jit import inner


@inner
def cross(a0, a1, a2, b0, b1, b2):
    """Vector product a x b."""
    return a1 * b2 - a2 * b1, a2 * b0 - a0 * b2, a0 * b1 - a1 * b0


@inner
def turn(rotation, i, x, y, z):
    """Components in the parent frame of a vector of frame i: R x."""
    return (
        rotation[i, 0, 0] * x + rotation[i, 0, 1] * y + rotation[i, 0, 2] * z,
        rotation[i, 1, 0] * x + rotation[i, 1, 1] * y + rotation[i, 1, 2] * z,
        rotation[i, 2, 0] * x + rotation[i, 2, 1] * y + rotation[i, 2, 2] * z,
    )


@inner
def turn_back(rotation, i, x, y, z):
    """Components in frame i of a vector of the parent frame: R^T x."""
    return (
        rotation[i, 0, 0] * x + rotation[i, 1, 0] * y + rotation[i, 2, 0] * z,
        rotation[i, 0, 1] * x + rotation[i, 1, 1] * y + rotation[i, 2, 1] * z,
        rotation[i, 0, 2] * x + rotation[i, 1, 2] * y + rotation[i, 2, 2] * z,
    )


@inner
def turn_about_z(tree, i, angle, rotation):
    """Set rotation[i] = tree[i] Rz(angle): joint frame to parent, turned by the joint."""
    c, s = math.cos(angle), math.sin(angle)
    for row in range(3):
        x, y = tree[i, row, 0], tree[i, row, 1]
        rotation[i, row, 0] = x * c + y * s
        rotation[i, row, 1] = y * c - x * s
        rotation[i, row, 2] = tree[i, row, 2]


@inner
def motion_to_child(rotation, position, i, v0, v1, v2, w0, w1, w2):
    """Motion of the parent seen from frame i: (R^T (v + w x p), R^T w)."""
    a0, a1, a2 = cross(w0, w1, w2, position[i, 0], position[i, 1], position[i, 2])
    u0, u1, u2 = turn_back(rotation, i, v0 + a0, v1 + a1, v2 + a2)
    x0, x1, x2 = turn_back(rotation, i, w0, w1, w2)
    return u0, u1, u2, x0, x1, x2


@inner
def force_to_parent(rotation, position, i, f0, f1, f2, n0, n1, n2):
    """Force on frame i about the parent's origin: (R f, R n + p x R f)."""
    g0, g1, g2 = turn(rotation, i, f0, f1, f2)
    m0, m1, m2 = turn(rotation, i, n0, n1, n2)
    c0, c1, c2 = cross(position[i, 0], position[i, 1], position[i, 2], g0, g1, g2)
    return g0, g1, g2, m0 + c0, m1 + c1, m2 + c2


@inner
def times(inertia, i, v0, v1, v2, w0, w1, w2):
    """Momentum I v of body i."""
    return (
        _row(inertia, i, 0, v0, v1, v2, w0, w1, w2),
        _row(inertia, i, 1, v0, v1, v2, w0, w1, w2),
        _row(inertia, i, 2, v0, v1, v2, w0, w1, w2),
        _row(inertia, i, 3, v0, v1, v2, w0, w1, w2),
        _row(inertia, i, 4, v0, v1, v2, w0, w1, w2),
        _row(inertia, i, 5, v0, v1, v2, w0, w1, w2),
    )


@inner
def _row(inertia, i, k, v0, v1, v2, w0, w1, w2):
    return (
        inertia[i, k, 0] * v0
        + inertia[i, k, 1] * v1
        + inertia[i, k, 2] * v2
        + inertia[i, k, 3] * w0
        + inertia[i, k, 4] * w1
        + inertia[i, k, 5] * w2
    )


@inner
def gyroscopic(inertia, i, v0, v1, v2, w0, w1, w2):
    """Kirchhoff's C(v) v = (w x p, w x h + v x p) with the momentum (p, h) = I v of body i.

    With rigid and added mass in one symmetric I this is C_RB nu + C_A nu_r of section 2.2 in
    one: the momentum B = dT/dv of section 2.2.1, turning with the body.
    """
    p0, p1, p2, h0, h1, h2 = times(inertia, i, v0, v1, v2, w0, w1, w2)
    f0, f1, f2 = cross(w0, w1, w2, p0, p1, p2)
    n0, n1, n2 = cross(w0, w1, w2, h0, h1, h2)
    m0, m1, m2 = cross(v0, v1, v2, p0, p1, p2)
    return f0, f1, f2, n0 + m0, n1 + m1, n2 + m2


@inner
def weight(model, i, k0, k1, k2):
    """Weight and buoyancy of body i as a force; (k0, k1, k2) points down in its frame."""
    w = model.net_weight[i]
    moment = model.net_moment
    n0, n1, n2 = cross(moment[i, 0], moment[i, 1], moment[i, 2], k0, k1, k2)
    return w * k0, w * k1, w * k2, n0, n1, n2


@inner
def store(table, i, a0, a1, a2, a3, a4, a5):
    """Write six numbers to row i."""
    table[i, 0], table[i, 1], table[i, 2] = a0, a1, a2
    table[i, 3], table[i, 4], table[i, 5] = a3, a4, a5


@inner
def load(table, i):
    """Read six numbers of row i."""
    return table[i, 0], table[i, 1], table[i, 2], table[i, 3], table[i, 4], table[i, 5]


@inner
def accumulate(table, i, a0, a1, a2, a3, a4, a5):
    """Add six numbers to row i."""
    table[i, 0] += a0
    table[i, 1] += a1
    table[i, 2] += a2
    table[i, 3] += a3
    table[i, 4] += a4
    table[i, 5] += a5
