"""Steps that forward and inverse dynamics share: velocities and forces of hull and links."""

import numpy as np

from uvms_dynamics.kernels.arithmetic import sine_cosine
from uvms_dynamics.kernels.damping import hull_damping
from uvms_dynamics.kernels.drag import SLOT_NUMBERS, gather_drag
from uvms_dynamics.kernels.inertia import load_inertia
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    COS,
    COS_TURN,
    FORCE,
    GROUPS,
    HULL,
    INERTIA,
    JOINTS,
    OFFSET,
    SIN,
    SIN_TURN,
    WORK_COLUMNS,
)
from uvms_dynamics.kernels.numba_internals.lanes import LANES
from uvms_dynamics.kernels.spatial import (
    angular,
    gyroscopic,
    linear,
    minus,
    motion_to_child,
    pair,
    plus,
    store_spatial,
    turned,
    weight,
)


@kernel
def make_workspace(model):
    """Scratch table (rows, 21) for a model; its contents do not outlive a call."""
    slots = SLOT_NUMBERS * LANES * np.int64(model[HULL, GROUPS])
    return np.zeros((np.int64(model[HULL, JOINTS]) + 1 - (-slots // WORK_COLUMNS), WORK_COLUMNS))


@inner
def check_joints(model, q, q_dot, other):
    """Raise ValueError unless these three have a value for each joint of the model."""
    n = np.int64(model[HULL, JOINTS])
    if q.shape[0] != n or q_dot.shape[0] != n or other.shape[0] != n:
        raise ValueError("q, its derivatives and the joint torques need as many values as joints")


@inner
def check_quaternion(quat):
    """Raise ValueError unless a quaternion has four values: kernels read without bounds."""
    if len(quat) != 4:
        raise ValueError("quat needs 4 values: x, y, z, w")


@inner
def check_motion(nu_r, nu_r_dot):
    """Raise ValueError unless both have six values."""
    if len(nu_r) != 6 or len(nu_r_dot) != 6:
        raise ValueError("nu_r and nu_r_dot need 6 values: linear, then angular")


@inner
def down_in_body(x, y, z, w):
    """World's down (0, 0, 1) in the body frame: the last row of R_world_body."""
    return 2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)


@inner
def to_hull(model, a):
    """Components in the hull's frame of a vector of the body frame: Rz(turn)^T a."""
    x, y = turned(model[HULL, COS_TURN], -model[HULL, SIN_TURN], a[0], a[1])
    return x, y, a[2]


@inner
def to_body(model, a):
    """Components in the body frame of a vector of the hull's frame."""
    x, y = turned(model[HULL, COS_TURN], model[HULL, SIN_TURN], a[0], a[1])
    return x, y, a[2]


@inner
def into_hull(model, a):
    """A motion or force of the body frame in the hull's."""
    return pair(to_hull(model, linear(a)), to_hull(model, angular(a)))


@inner
def into_body(model, a):
    """A motion or force of the hull's frame in the body frame."""
    return pair(to_body(model, linear(a)), to_body(model, angular(a)))


@inner
def set_angle(model, work, i, angle):
    """Sine and cosine of joint i with its offset."""
    work[i, SIN], work[i, COS] = sine_cosine(angle + model[i, OFFSET])


@inner
def link_velocity(model, work, i, v, rate):
    """Velocity of link i from its parent's, eq. (2)-(7)."""
    v0, v1, v2, w0, w1, w2 = motion_to_child(model, work, i, v)
    return v0, v1, v2, w0, w1, w2 + rate


@inner
def velocity_product(v, rate):
    """V x S q_dot = (v0, v1, w0, w1): acceleration of a link for its turning in a moving frame.

    It has no parts along z.
    """
    return rate * v[1], -rate * v[0], rate * v[4], -rate * v[3]


@inner
def set_link_force(model, work, i, v, down, other):
    """FORCE of link i: C(v) v less weight and buoyancy, and another force; its drag follows."""
    store_spatial(work, i, FORCE, plus(undamped_force(model, i, v, down), other))
    gather_drag(model, work, i, v)


@inner
def hull_bias_force(model, v, down):
    """C(v) v less weight and buoyancy, with damping, of the hull, in its frame."""
    damping = into_hull(model, hull_damping(model, into_body(model, v)))
    return plus(undamped_force(model, HULL, v, down), damping)


@inner
def undamped_force(model, i, v, down):
    """C(v) v less weight and buoyancy of body i."""
    return minus(gyroscopic(load_inertia(model, i, INERTIA), v), weight(model, i, down))
