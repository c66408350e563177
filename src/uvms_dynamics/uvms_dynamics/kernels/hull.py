"""Forces on the hull that depend on its velocity through the water."""

import math

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.spatial import gyroscopic, times


@kernel
def hull_bias_wrench(model, nu_r):
    """C(nu_r) nu_r + D(nu_r) nu_r (6,) of the hull alone, rigid body and added mass together.

    nu_r (6,) is the velocity relative to the water, body frame. Section 2.2 of the paper.
    """
    out = np.empty(6)
    out[0], out[1], out[2], out[3], out[4], out[5] = hull_bias(
        model, nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5]
    )
    return out


@inner
def hull_bias(model, u, v, w, p, q, r):
    """The same in scalars."""
    f0, f1, f2, n0, n1, n2 = gyroscopic(model.inertia, 0, u, v, w, p, q, r)
    return (
        f0 + damping(model, 0, u),
        f1 + damping(model, 1, v),
        f2 + damping(model, 2, w),
        n0 + damping(model, 3, p),
        n1 + damping(model, 4, q),
        n2 + damping(model, 5, r),
    )


@inner
def damping(model, k, x):
    """Linear and quadratic damping of one degree of freedom: (d_k + d_kk |x|) x."""
    return (model.linear_damping[k] + model.quadratic_damping[k] * math.fabs(x)) * x


@kernel
def hull_hydrodynamic_wrench(model, nu_r, nu_r_dot):
    """What the water does TO the hull (6,): -(M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r)."""
    v0, v1, v2, w0, w1, w2 = nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5]
    f0, f1, f2, n0, n1, n2 = gyroscopic(model.added_mass, 0, v0, v1, v2, w0, w1, w2)
    a0, a1, a2 = nu_r_dot[0], nu_r_dot[1], nu_r_dot[2]
    b0, b1, b2 = nu_r_dot[3], nu_r_dot[4], nu_r_dot[5]
    g0, g1, g2, m0, m1, m2 = times(model.added_mass, 0, a0, a1, a2, b0, b1, b2)
    out = np.empty(6)
    out[0], out[1], out[2] = -f0 - g0, -f1 - g1, -f2 - g2
    out[3], out[4], out[5] = -n0 - m0, -n1 - m1, -n2 - m2
    for k in range(6):
        out[k] -= damping(model, k, nu_r[k])
    return out
