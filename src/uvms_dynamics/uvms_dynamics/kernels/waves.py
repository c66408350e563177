"""Forces on hull and links in a flow that varies in space, each body in the flow at its own place.

Velocities and accelerations of the bodies are relative to the frame that moves with the uniform
part of the flow. A table `wet` has a row for each body with what it is to the water and with the
rest of the flow at its centre of buoyancy: velocity w and material acceleration w' = Dw/Dt, in the
body's own axes, taken as uniform over the body (long waves; Newman 1977, ch. 6). Then

    added mass        M_A (v - w)' + C_A(v - w) (v - w)    with (v - w)' = v' - (w' - omega x w)
    drag              D(v - w) (v - w)
    pressure          -rho V w'  at the centre of buoyancy (Froude-Krylov)

are needed in place of M_A v' + C_A(v) v and D(v) v. Added mass with Dw/Dt, not with the derivative
along the body's own path, is what potential flow gives (Taylor 1928; Auton, Hunt and Prud'homme
1988). Where the flow is uniform `wet` is None and none of this is compiled.
"""

import numpy as np
from numba import types
from numba.extending import overload

from uvms_dynamics.kernels.damping import hull_damping
from uvms_dynamics.kernels.drag import gather_drag
from uvms_dynamics.kernels.inertia import load_inertia
from uvms_dynamics.kernels.jit import OPTIONS, inner
from uvms_dynamics.kernels.layout import FORCE, HULL
from uvms_dynamics.kernels.motion import (
    hull_bias_force,
    into_body,
    into_hull,
    set_link_force,
    undamped_force,
)
from uvms_dynamics.kernels.spatial import (
    angular,
    cross,
    gyroscopic,
    load3,
    minus,
    pair,
    plus,
    store_spatial,
    times,
)

ADDED, DISPLACED, CENTRE, FLOW, FLOW_RATE, WET_COLUMNS = np.cumsum([0, 21, 1, 3, 3, 3])
"""Columns of `wet`: added mass (21) as in `layout`, displaced mass, centre of buoyancy (3); w (3)
and Dw/Dt (3) in the axes of the body's frame."""


def set_link_force_in(model, wet, work, i, v, down, other):
    """As `set_link_force`, in the flow of `wet`; its drag follows."""


def hull_bias_force_in(model, wet, v, down):
    """As `hull_bias_force`, in the flow of `wet`."""


@overload(set_link_force_in, jit_options=OPTIONS)
def _set_link_force_in(model, wet, work, i, v, down, other):
    if isinstance(wet, types.NoneType):
        return lambda model, wet, work, i, v, down, other: set_link_force(
            model, work, i, v, down, other
        )
    return _set_link_force_in_waves


@overload(hull_bias_force_in, jit_options=OPTIONS)
def _hull_bias_force_in(model, wet, v, down):
    if isinstance(wet, types.NoneType):
        return lambda model, wet, v, down: hull_bias_force(model, v, down)
    return _hull_bias_force_in_waves


def _set_link_force_in_waves(model, wet, work, i, v, down, other):
    force = plus(undamped_force(model, i, v, down), wave_force(wet, i, v))
    store_spatial(work, i, FORCE, plus(force, other))
    gather_drag(model, work, i, relative(wet, i, v))


def _hull_bias_force_in_waves(model, wet, v, down):
    through = into_body(model, relative(wet, HULL, v))
    force = plus(
        undamped_force(model, HULL, v, down), into_hull(model, hull_damping(model, through))
    )
    return plus(force, wave_force(wet, HULL, v))


@inner
def relative(wet, i, v):
    """Velocity of body i relative to the water around it."""
    w = load3(wet, i, FLOW)
    return v[0] - w[0], v[1] - w[1], v[2] - w[2], v[3], v[4], v[5]


@inner
def wave_force(wet, i, v):
    """Force that body i needs in the flow beside that in none, without drag."""
    inertia, turn = load_inertia(wet, i, ADDED), angular(v)
    rate, swept = load3(wet, i, FLOW_RATE), cross(turn, load3(wet, i, FLOW))
    slip = swept[0] - rate[0], swept[1] - rate[1], swept[2] - rate[2]
    added = times(inertia, pair(slip, (0.0, 0.0, 0.0)))
    added = plus(added, minus(gyroscopic(inertia, relative(wet, i, v)), gyroscopic(inertia, v)))
    mass = wet[i, DISPLACED]
    pressure = mass * rate[0], mass * rate[1], mass * rate[2]
    return minus(added, pair(pressure, cross(load3(wet, i, CENTRE), pressure)))
