"""Forces on the hull that depend on its motion through the water."""

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import (
    ADDED_MASS,
    ANGULAR_PART,
    DOWN,
    HULL,
    JOINTS,
    LINEAR_PART,
)
from uvms_dynamics.kernels.forward import set_hull
from uvms_dynamics.kernels.motion import damping, hull_bias_force, make_workspace, to_body
from uvms_dynamics.kernels.spatial import gyroscopic, times


@kernel
def hull_bias_wrench(model, nu_r):
    """C(nu_r) nu_r + D(nu_r) nu_r (6,) of the hull alone, rigid body and added mass together.

    nu_r (6,) is the velocity relative to the water, body frame. Section 2.2 of the paper.
    """
    work, out = make_workspace(0), np.empty(6)
    set_hull(model, work, (0.0, 0.0, 0.0), nu_r, LINEAR_PART)  # no down, no weight
    f0, f1, f2, n0, n1, n2 = hull_bias_force(model, work)
    out[0], out[1], out[2] = to_body(model, f0, f1, f2)
    out[3], out[4], out[5] = to_body(model, n0, n1, n2)
    return out


@kernel
def hull_hydrodynamic_wrench(model, nu_r, nu_r_dot):
    """What the water does TO the hull (6,): -(M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r)."""
    u, v, w, p, q, r = nu_r[0], nu_r[1], nu_r[2], nu_r[3], nu_r[4], nu_r[5]
    row = np.int64(model[HULL, JOINTS]) + 1
    turning = gyroscopic(model, row, ADDED_MASS, u, v, w, p, q, r)
    u, v, w, p, q, r = (
        nu_r_dot[0], nu_r_dot[1], nu_r_dot[2], nu_r_dot[3], nu_r_dot[4], nu_r_dot[5],
    )  # fmt: skip
    inertia = times(model, row, ADDED_MASS, u, v, w, p, q, r)
    linear = damping(model, LINEAR_PART, nu_r[0], nu_r[1], nu_r[2])
    angular = damping(model, ANGULAR_PART, nu_r[3], nu_r[4], nu_r[5])
    out = np.empty(6)
    for k in range(3):
        out[k] = -(inertia[k] + turning[k] + linear[k])
        out[3 + k] = -(inertia[3 + k] + turning[3 + k] + angular[k])
    return out
