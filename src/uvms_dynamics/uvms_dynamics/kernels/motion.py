"""Steps that forward and inverse dynamics share: what body i goes through and feels."""

import numpy as np

from uvms_dynamics.kernels.arithmetic import sine_cosine, size
from uvms_dynamics.kernels.drag import link_drag
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    ANGULAR_PART,
    COS,
    COS_TURN,
    DAMPING,
    DOWN,
    FORCE,
    HULL,
    INERTIA,
    LINEAR_PART,
    OFFSET,
    QUADRATIC,
    RATE,
    SIN,
    SIN_TURN,
    VELOCITY,
    WORK_COLUMNS,
)
from uvms_dynamics.kernels.spatial import (
    gyroscopic,
    load,
    load3,
    motion_to_child,
    store,
    store3,
    to_child,
    weight,
)


@kernel
def make_workspace(n):
    """Scratch table (n+1, ..) of an arm of n joints; its contents do not outlive a call."""
    return np.empty((n + 1, WORK_COLUMNS))


@inner
def down_in_body(x, y, z, w):
    """World's down (0, 0, 1) in the body frame: the last row of R_world_body."""
    return 2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)


@inner
def to_hull(model, x, y, z):
    """Components in the hull's frame of a vector of the body frame: Rz(turn)^T v."""
    c, s = model[HULL, COS_TURN], model[HULL, SIN_TURN]
    return c * x + s * y, c * y - s * x, z


@inner
def to_body(model, x, y, z):
    """Components in the body frame of a vector of the hull's frame."""
    c, s = model[HULL, COS_TURN], model[HULL, SIN_TURN]
    return c * x - s * y, s * x + c * y, z


@inner
def set_angle(model, work, i, angle):
    """Sine and cosine of joint i with its offset."""
    work[i, SIN], work[i, COS] = sine_cosine(angle + model[i, OFFSET])


@inner
def carry_velocity(model, work, i):
    """Velocity of link i from its parent's, eq. (2)-(7); returns V x S q_dot's four parts."""
    rate = work[i, RATE]
    v0, v1, v2, w0, w1, w2 = load(work, i - 1, VELOCITY)
    v0, v1, v2, w0, w1, w2 = motion_to_child(model, work, i, v0, v1, v2, w0, w1, w2)
    store(work, i, VELOCITY, v0, v1, v2, w0, w1, w2 + rate)
    return rate * v1, -rate * v0, rate * w1, -rate * w0


@inner
def carry_down(model, work, i):
    """Down direction in frame i."""
    k0, k1, k2 = load3(work, i - 1, DOWN)
    k0, k1, k2 = to_child(model, work, i, k0, k1, k2)
    store3(work, i, DOWN, k0, k1, k2)


@inner
def link_bias_force(model, work, i):
    """C(v) v less weight, buoyancy and drag of link i: the force that it needs besides I a."""
    v0, v1, v2, w0, w1, w2 = load(work, i, VELOCITY)
    f0, f1, f2, n0, n1, n2 = _unresisted(model, work, i)
    d0, d1, d2, m0, m1, m2 = link_drag(model, i, v0, v1, v2, w0, w1, w2)
    return f0 - d0, f1 - d1, f2 - d2, n0 - m0, n1 - m1, n2 - m2


@inner
def hull_bias_force(model, work):
    """C(v) v less weight and buoyancy, with damping, of the hull, in its frame."""
    v0, v1, v2, w0, w1, w2 = load(work, HULL, VELOCITY)
    f0, f1, f2, n0, n1, n2 = _unresisted(model, work, HULL)
    v0, v1, v2 = damping(model, LINEAR_PART, *to_body(model, v0, v1, v2))
    w0, w1, w2 = damping(model, ANGULAR_PART, *to_body(model, w0, w1, w2))
    v0, v1, v2 = to_hull(model, v0, v1, v2)
    w0, w1, w2 = to_hull(model, w0, w1, w2)
    return f0 + v0, f1 + v1, f2 + v2, n0 + w0, n1 + w1, n2 + w2


@inner
def damping(model, k, x, y, z):
    """Linear and quadratic damping of three degrees of freedom, (d_k + d_kk |x|) x; body axes."""
    linear, quadratic = load3(model, HULL, DAMPING + k), load3(model, HULL, QUADRATIC + k)
    return (
        (linear[0] + quadratic[0] * size(x)) * x,
        (linear[1] + quadratic[1] * size(y)) * y,
        (linear[2] + quadratic[2] * size(z)) * z,
    )


@inner
def _unresisted(model, work, i):
    """C(v) v less weight and buoyancy of body i."""
    v0, v1, v2, w0, w1, w2 = load(work, i, VELOCITY)
    f0, f1, f2, n0, n1, n2 = gyroscopic(model, i, INERTIA, v0, v1, v2, w0, w1, w2)
    k0, k1, k2 = load3(work, i, DOWN)
    g0, g1, g2, m0, m1, m2 = weight(model, i, k0, k1, k2)
    return f0 - g0, f1 - g1, f2 - g2, n0 - m0, n1 - m1, n2 - m2
