"""Spatial algebra in tuples of numbers: vectors, motions, forces and symmetric 6x6 inertias.

Everything is written out in numbers, because numba then keeps them in registers; small matrix
products with their temporaries were 17 times slower. A vector is three numbers; a motion (v, omega)
or a force (f, n) is six, linear part first, about the origin of its frame; an inertia
[A, B; B^T, C] is 21: the upper triangle of A row by row, B row by row, the upper triangle of C.
`i` is the row of a body. Notation: Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 2.

Every joint turns about the z axis of its frame, which lies in the parent's at Tr(p) Rx(twist); any
chain can be written so (`model.vehicle_table`), and two turns in a plane cost less than one in
space.
"""

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import (
    COS,
    COS_TWIST,
    NET_MOMENT,
    NET_WEIGHT,
    PLACE,
    SIN,
    SIN_TWIST,
)


@inner
def load3(table, i, k):
    """Vector in row i from column k on."""
    return table[i, k], table[i, k + 1], table[i, k + 2]


@inner
def load6(table, i, k):
    """Motion or force in row i from column k on."""
    return (
        table[i, k],
        table[i, k + 1],
        table[i, k + 2],
        table[i, k + 3],
        table[i, k + 4],
        table[i, k + 5],
    )


@inner
def spatial_at(a, k):
    """Motion or force in an array, from entry k on."""
    return a[k], a[k + 1], a[k + 2], a[k + 3], a[k + 4], a[k + 5]


@inner
def store_spatial(table, i, k, a):
    """Write a motion or force to row i from column k on."""
    table[i, k], table[i, k + 1], table[i, k + 2] = a[0], a[1], a[2]
    table[i, k + 3], table[i, k + 4], table[i, k + 5] = a[3], a[4], a[5]


@inner
def cross(a, b):
    """Vector product a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inner
def add_vectors(a, b):
    """Sum of two vectors."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


@inner
def plus(a, b):
    """Sum of two motions or forces."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5]


@inner
def minus(a, b):
    """Difference of two motions or forces."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3], a[4] - b[4], a[5] - b[5]


@inner
def pair(a, b):
    """A motion or force of its linear and its angular vector."""
    return a[0], a[1], a[2], b[0], b[1], b[2]


@inner
def linear(a):
    """The first vector of a motion or force."""
    return a[0], a[1], a[2]


@inner
def angular(a):
    """The second vector of a motion or force."""
    return a[3], a[4], a[5]


@inner
def turned(c, s, x, y):
    """A vector of the plane, turned by an angle with this cosine and sine."""
    return c * x - s * y, s * x + c * y


@inner
def to_parent(model, work, i, a):
    """Components in the parent frame of a vector of frame i: Rx(twist) Rz(q) a."""
    x, y = turned(work[i, COS], work[i, SIN], a[0], a[1])
    y, z = turned(model[i, COS_TWIST], model[i, SIN_TWIST], y, a[2])
    return x, y, z


@inner
def to_child(model, work, i, a):
    """Components in frame i of a vector of the parent frame."""
    y, z = turned(model[i, COS_TWIST], -model[i, SIN_TWIST], a[1], a[2])
    x, y = turned(work[i, COS], -work[i, SIN], a[0], y)
    return x, y, z


@inner
def motion_to_child(model, work, i, a):
    """Motion of the parent seen from frame i: (R^T (v + w x p), R^T w)."""
    moved = add_vectors(linear(a), cross(angular(a), load3(model, i, PLACE)))
    return pair(to_child(model, work, i, moved), to_child(model, work, i, angular(a)))


@inner
def force_to_parent(model, work, i, a):
    """Force on frame i about the parent's origin: (R f, R n + p x R f)."""
    f = to_parent(model, work, i, linear(a))
    n = to_parent(model, work, i, angular(a))
    return pair(f, add_vectors(n, cross(load3(model, i, PLACE), f)))


@inner
def times(inertia, a):
    """Momentum (p, h) = I (v, w)."""
    a00, a01, a02, a11, a12, a22 = inertia[:6]
    b00, b01, b02, b10, b11, b12, b20, b21, b22 = inertia[6:15]
    c00, c01, c02, c11, c12, c22 = inertia[15:]
    v0, v1, v2, w0, w1, w2 = a
    return (
        (a00 * v0 + a01 * v1 + a02 * v2) + (b00 * w0 + b01 * w1 + b02 * w2),
        (a01 * v0 + a11 * v1 + a12 * v2) + (b10 * w0 + b11 * w1 + b12 * w2),
        (a02 * v0 + a12 * v1 + a22 * v2) + (b20 * w0 + b21 * w1 + b22 * w2),
        (b00 * v0 + b10 * v1 + b20 * v2) + (c00 * w0 + c01 * w1 + c02 * w2),
        (b01 * v0 + b11 * v1 + b21 * v2) + (c01 * w0 + c11 * w1 + c12 * w2),
        (b02 * v0 + b12 * v1 + b22 * v2) + (c02 * w0 + c12 * w1 + c22 * w2),
    )


@inner
def gyroscopic(inertia, a):
    """Kirchhoff's C(v) v = (w x p, w x h + v x p) with the momentum (p, h) = I v of a body.

    With rigid and added mass in one symmetric I this is C_RB nu + C_A nu_r of section 2.2 in
    one: the momentum B = dT/dv of section 2.2.1, turning with the body.
    """
    momentum = times(inertia, a)
    p, h, v, w = linear(momentum), angular(momentum), linear(a), angular(a)
    return pair(cross(w, p), add_vectors(cross(w, h), cross(v, p)))


@inner
def weight(model, i, down):
    """Weight and buoyancy of body i as a force; `down` is the unit vector in its frame."""
    w = model[i, NET_WEIGHT]
    return pair((w * down[0], w * down[1], w * down[2]), cross(load3(model, i, NET_MOMENT), down))
