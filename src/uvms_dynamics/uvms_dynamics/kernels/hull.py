"""Forces on the hull that depend on its motion through the water."""

import numpy as np

from uvms_dynamics.kernels.damping import hull_damping
from uvms_dynamics.kernels.inertia import load_inertia
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.layout import ADDED_MASS, FIRST, HULL, JOINTS
from uvms_dynamics.kernels.motion import (
    check_motion,
    hull_bias_force,
    into_body,
    into_hull,
)
from uvms_dynamics.kernels.spatial import gyroscopic, plus, spatial_at, times


@kernel
def hull_bias_wrench(model, nu_r):
    """C(nu_r) nu_r + D(nu_r) nu_r (6,) of the hull alone, rigid body and added mass together.

    nu_r (6,) is the velocity relative to the water, body frame. Section 2.2 of the paper.
    """
    check_motion(nu_r, nu_r)
    nu = spatial_at(nu_r, FIRST)
    no_weight = (0.0, 0.0, 0.0)
    wrench = into_body(model, hull_bias_force(model, into_hull(model, nu), no_weight))
    out = np.empty(6)
    for k in range(6):
        out[k] = wrench[k]
    return out


@kernel
def hull_hydrodynamic_wrench(model, nu_r, nu_r_dot):
    """What the water does TO the hull (6,): -(M_A nu_r_dot + C_A(nu_r) nu_r + D(nu_r) nu_r)."""
    check_motion(nu_r, nu_r_dot)
    nu = spatial_at(nu_r, FIRST)
    rate = spatial_at(nu_r_dot, FIRST)
    inertia = load_inertia(model, np.int64(model[HULL, JOINTS]) + 1, ADDED_MASS)
    wrench = plus(times(inertia, rate), plus(gyroscopic(inertia, nu), hull_damping(model, nu)))
    out = np.empty(6)
    for k in range(6):
        out[k] = -wrench[k]
    return out
