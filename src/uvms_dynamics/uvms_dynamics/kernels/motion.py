"""Steps that forward and inverse dynamics share: what link i goes through and feels."""

import numpy as np

from uvms_dynamics.kernels.drag import strip_drag
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import DOWN, FORCE, VELOCITY, WORK_COLUMNS
from uvms_dynamics.kernels.spatial import (
    add,
    gyroscopic,
    load,
    load3,
    motion_to_child,
    store,
    store3,
    turn_back,
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
def carry_velocity(joints, work, i, rate):
    """Velocity of link i from its parent's, eq. (2)-(7); returns V x S q_dot's four parts."""
    v0, v1, v2, w0, w1, w2 = load(work, i - 1, VELOCITY)
    v0, v1, v2, w0, w1, w2 = motion_to_child(joints, work, i, v0, v1, v2, w0, w1, w2)
    store(work, i, VELOCITY, v0, v1, v2, w0, w1, w2 + rate)
    return rate * v1, -rate * v0, rate * w1, -rate * w0


@inner
def carry_down(work, i):
    """Down direction in frame i."""
    k0, k1, k2 = load3(work, i - 1, DOWN)
    k0, k1, k2 = turn_back(work, i, k0, k1, k2)
    store3(work, i, DOWN, k0, k1, k2)


@inner
def bias_force(bodies, work, i):
    """Set the force of body i to C(v) v less weight and buoyancy."""
    v0, v1, v2, w0, w1, w2 = load(work, i, VELOCITY)
    f0, f1, f2, n0, n1, n2 = gyroscopic(bodies, i, v0, v1, v2, w0, w1, w2)
    store(work, i, FORCE, f0, f1, f2, n0, n1, n2)
    k0, k1, k2 = load3(work, i, DOWN)
    f0, f1, f2, n0, n1, n2 = weight(bodies, i, k0, k1, k2)
    add(work, i, FORCE, -f0, -f1, -f2, -n0, -n1, -n2)


@inner
def resist(strips, start, coefficient, work, i):
    """Add the drag that link i must overcome to its force."""
    v0, v1, v2, w0, w1, w2 = load(work, i, VELOCITY)
    for s in range(start[i - 1], start[i]):
        f0, f1, f2, n0, n1, n2 = strip_drag(strips, coefficient, s, v0, v1, v2, w0, w1, w2)
        add(work, i, FORCE, -f0, -f1, -f2, -n0, -n1, -n2)
