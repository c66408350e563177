"""Forces on the hull that depend on its motion through the water."""

import math

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import ADDED_MASS, HULL, LINEAR, QUADRATIC
from uvms_dynamics.kernels.spatial import gyroscopic


@kernel
def hull_bias_wrench(model, nu_r):
    """C(nu_r) nu_r + D(nu_r) nu_r (6,) of the hull alone, rigid body and added mass together.

    nu_r (6,) is the velocity relative to the water, body frame. Section 2.2 of the paper.
    """
    out = np.empty(6)
    u, v, w, p, q, r = nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5]
    out[0], out[1], out[2], out[3], out[4], out[5] = gyroscopic(
        model.bodies, HULL, u, v, w, p, q, r
    )
    for k in range(6):
        out[k] += damping(model.hull, k, nu_r[k])
    return out


@kernel
def hull_hydrodynamic_wrench(model, nu_r, nu_r_dot):
    """What the water does TO the hull (6,): -(M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r)."""
    matrix = np.empty((1, 36))
    for k in range(36):
        matrix[0, k] = model.hull[ADDED_MASS + k // 6, k % 6]
    u, v, w, p, q, r = nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5]
    out = np.empty(6)
    out[0], out[1], out[2], out[3], out[4], out[5] = gyroscopic(matrix, HULL, u, v, w, p, q, r)
    for k in range(6):
        total = out[k] + damping(model.hull, k, nu_r[k])
        for j in range(6):
            total += matrix[0, 6 * k + j] * nu_r_dot[j]
        out[k] = -total
    return out


@inner
def damping(hull, k, x):
    """Linear and quadratic damping of one degree of freedom: (d_k + d_kk |x|) x."""
    return (hull[LINEAR, k] + hull[QUADRATIC, k] * math.fabs(x)) * x
