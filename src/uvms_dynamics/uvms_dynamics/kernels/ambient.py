"""What water that is not as the model has it does to a vehicle that moves through it.

A current v_c, constant in the world, acts on hull and arm beside the model's wrench over ground by

    h(nu - v_c, omega x v_c) - h(nu, 0),    h(nu_r, nu_r_dot) = -(M nu_r_dot + C nu_r + D nu_r)

of rigid bodies, where it cancels, and water (Fossen 2011, sections 8.1 and 8.3). At rest this is a
constant; in a turn and with speed it changes.
"""

import numpy as np

from uvms_dynamics.kernels.hull import hull_hydrodynamic_wrench
from uvms_dynamics.kernels.inverse import coupling_wrench
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix

CURRENT_SIGMA, HYDRODYNAMICS_SIGMA = 0.2, 0.2
"""m/s along each axis of the world; share to which the model knows its hull's hydrodynamics."""
WATER_COLUMNS = 4


@exact_kernel
def water_wrenches(model, quat, nu, q, q_dot):
    """Wrenches (6, 4) that one standard deviation of each of the water's unknowns makes.

    Args:
        model: as of `build_model`.
        quat: (4,) unit, (x, y, z, w), of the body in the world.
        nu: (6,) over ground, body frame, m/s and rad/s.
        q, q_dot: (n,) rad, rad/s.

    Returns:
        Columns: a current along the world's x, y and z, as the chord from -sigma to sigma, since
        drag is quadratic; an error of the hull's own damping and Coriolis wrench. They act ON the
        vehicle, body frame, N and N m.
    """
    wrenches = np.empty((6, WATER_COLUMNS))
    R = quat_to_matrix(quat)
    for k in range(3):
        current = CURRENT_SIGMA * R[k]
        ahead = _in_current(model, nu, current, q, q_dot)
        wrenches[:, k] = 0.5 * (ahead - _in_current(model, nu, -current, q, q_dot))
    wrenches[:, 3] = HYDRODYNAMICS_SIGMA * hull_hydrodynamic_wrench(model, nu, np.zeros(6))
    return wrenches


@exact_kernel
def _in_current(model, nu, current, q, q_dot):
    """Wrench h (6,) in a current (3,), m/s in body axes."""
    nu_r, nu_r_dot = nu.copy(), np.zeros(6)
    nu_r[:3] -= current
    nu_r_dot[:3] = np.cross(nu[3:], current)
    arm = coupling_wrench(model, nu_r, nu_r_dot, q, q_dot, np.zeros_like(q))
    return hull_hydrodynamic_wrench(model, nu_r, nu_r_dot) + arm
