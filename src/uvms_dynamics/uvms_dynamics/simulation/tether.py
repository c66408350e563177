"""The pull of a tether: a weight, and its first moment, that grow with the depth.

Only the simulation knows of it. For observer, controller and planner it is a disturbance.
"""

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import TETHER_DEPTH, TETHER_MOMENT, TETHER_REACH, TETHER_WEIGHT
from uvms_dynamics.kernels.numba_internals.primitives import maximum, minimum
from uvms_dynamics.kernels.spatial import cross, load3, pair


@inner
def tether_load(model, n, depth):
    """Weight (N, down) and its first moment (3, N m, body frame) at a depth, m: four numbers.

    w (d - d0) and m (d - d0) of `uvms_core.vehicle.Tether`, with |d - d0| cut at its reach; n is
    the number of joints.
    """
    reach = model[n + 1, TETHER_REACH]
    below = minimum(maximum(depth - model[n + 1, TETHER_DEPTH], -reach), reach)
    moment = load3(model, n + 1, TETHER_MOMENT)
    weight = model[n + 1, TETHER_WEIGHT]
    return weight * below, moment[0] * below, moment[1] * below, moment[2] * below


@inner
def load_wrench(load, down):
    """Body wrench (w k, m x k) of a weight w with the first moment m; k is down in body axes."""
    force = load[0] * down[0], load[0] * down[1], load[0] * down[2]
    return pair(force, cross((load[1], load[2], load[3]), down))


@kernel
def tether_load_at(model, n, depth):
    """As `tether_load`, for Python."""
    return tether_load(model, n, depth)


@kernel
def tether_wrench(model, n, depth, down):
    """Body wrench (6,) at a depth, m; down (3,) in body axes. For Python."""
    wrench = load_wrench(tether_load(model, n, depth), (down[0], down[1], down[2]))
    out = np.empty(6)
    for i in range(6):
        out[i] = wrench[i]
    return out
