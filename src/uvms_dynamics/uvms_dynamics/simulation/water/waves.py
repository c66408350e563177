"""Linear waves at the place of each body of the vehicle.

A wave of amplitude a, with psi = k x - omega t + phase along its direction and z down from the
surface, moves the water with

    u = a omega C cos psi,   w = -a omega S sin psi,   C, S = cosh, sinh k (h - z) / sinh k h

(Newman 1977, ch. 6; w is down). Waves are summed as if each were alone in still water. The
material acceleration has the products with the gradients, with all velocities of the water in them:
a body that is a part of the water then stays one.
"""

import numpy as np
from numba import types
from numba.extending import overload

from uvms_dynamics.kernels.arithmetic import sine_cosine
from uvms_dynamics.kernels.jit import OPTIONS, inner, kernel
from uvms_dynamics.kernels.layout import (
    COS,
    COS_TURN,
    COS_TWIST,
    FIRST,
    HULL,
    PLACE,
    SIN,
    SIN_TURN,
    SIN_TWIST,
)
from uvms_dynamics.kernels.numba_internals.primitives import maximum, minimum
from uvms_dynamics.kernels.spatial import add_vectors, load3, turned
from uvms_dynamics.kernels.waves import CENTRE, FLOW, FLOW_RATE


@inner
def wave_motion(waves, place, carried, time):
    """Velocity and material acceleration of the water by waves at a place in the world, 6 numbers.

    carried (3): velocity of the water beside the waves. Above the mean surface and below the bottom
    the flow is that at them.
    """
    v0, v1, v2, a0, a1, a2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    g00, g01, g02, g11, g12, g22 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(waves.shape[0]):
        k, omega, north, east = waves[i, 0], waves[i, 1], waves[i, 2], waves[i, 3]
        psi = k * (north * place[0] + east * place[1]) - omega * time + waves[i, 4]
        sine, cosine = sine_cosine(psi)
        across, down = _shape(k, waves[i, 6], place[2])
        speed = waves[i, 5] * omega
        u, du = speed * across * cosine, speed * across * sine
        w, dw = -speed * down * sine, speed * down * cosine
        v0, v1, v2 = v0 + u * north, v1 + u * east, v2 + w
        a0, a1, a2 = a0 + omega * du * north, a1 + omega * du * east, a2 + omega * dw
        # gradient, symmetric since the flow has no rotation, without trace since it has no source
        g00, g01, g11 = (
            g00 - k * du * north * north,
            g01 - k * du * north * east,
            g11 - k * du * east * east,
        )
        g02, g12, g22 = g02 - k * dw * north, g12 - k * dw * east, g22 + k * du
    t0, t1, t2 = add_vectors((v0, v1, v2), carried)
    a0 += g00 * t0 + g01 * t1 + g02 * t2
    a1 += g01 * t0 + g11 * t1 + g12 * t2
    a2 += g02 * t0 + g12 * t1 + g22 * t2
    return v0, v1, v2, a0, a1, a2


@inner
def _shape(k, depth, z):
    """C and S at z: cosh and sinh k (h - z) / sinh k h, in exponentials that do not overflow."""
    z = minimum(maximum(z, 0.0), depth)
    near, far = np.exp(-k * z), np.exp(-k * (2.0 * depth - z))
    scale = 1.0 / (1.0 - np.exp(-2.0 * k * depth))
    return (near + far) * scale, (near - far) * scale


@kernel
def wave_motion_at(waves, places, carried, times):
    """Velocity and material acceleration (k, 6) at places (k, 3) and times (k,), for Python."""
    out = np.empty((times.shape[0], 6))
    for k in range(times.shape[0]):
        flow = wave_motion(waves, load3(places, k, FIRST), load3(carried, k, FIRST), times[k])
        for i in range(6):
            out[k, i] = flow[i]
    return out


@kernel
def wave_head(waves, place, time):
    """Pressure by waves at a place (3,) in the world and a time, s, as metres of water.

    Linear: a cosh k (h - z) / cosh k h cos psi (Newman 1977, ch. 6).
    """
    head = 0.0
    for i in range(waves.shape[0]):
        k, depth = waves[i, 0], waves[i, 6]
        psi = k * (waves[i, 2] * place[0] + waves[i, 3] * place[1])
        _, cosine = sine_cosine(psi - waves[i, 1] * time + waves[i, 4])
        across, _ = _shape(k, depth, place[2])
        head += waves[i, 5] * across * np.tanh(k * depth) * cosine
    return head


def spread_waves(model, water, wet, work, n, place, quat, carried, time):
    """Set the flow in `wet` to that at each body; the workspace holds the joints' angles."""


def take_bodies(water, wet):
    """Set what the bodies are to the water in `wet`: the vehicle may be another than before."""


@overload(take_bodies, jit_options=OPTIONS)
def _take_bodies(water, wet):
    if isinstance(wet, types.NoneType):
        return lambda water, wet: None
    return _copy_bodies


def _copy_bodies(water, wet):
    for i in range(wet.shape[0]):
        for k in range(FLOW):
            wet[i, k] = water.bodies[i, k]


@overload(spread_waves, jit_options=OPTIONS)
def _spread_waves(model, water, wet, work, n, place, quat, carried, time):
    if isinstance(wet, types.NoneType):
        return lambda model, water, wet, work, n, place, quat, carried, time: None
    return _spread_over_bodies


def _spread_over_bodies(model, water, wet, work, n, place, quat, carried, time):
    frame = _turned_about_z(_rotation(quat), model[HULL, COS_TURN], model[HULL, SIN_TURN])
    _set_flow(water.waves, wet, HULL, place, frame, carried, time)
    for i in range(1, n + 1):
        place = add_vectors(place, _apply(frame, load3(model, i, PLACE)))
        frame = _turned_about_x(frame, model[i, COS_TWIST], model[i, SIN_TWIST])
        frame = _turned_about_z(frame, work[i, COS], work[i, SIN])
        _set_flow(water.waves, wet, i, place, frame, carried, time)


@inner
def _set_flow(waves, wet, i, place, frame, carried, time):
    centre = add_vectors(place, _apply(frame, load3(wet, i, CENTRE)))
    v0, v1, v2, a0, a1, a2 = wave_motion(waves, centre, carried, time)
    wet[i, FLOW], wet[i, FLOW + 1], wet[i, FLOW + 2] = _back(frame, (v0, v1, v2))
    k = FLOW_RATE
    wet[i, k], wet[i, k + 1], wet[i, k + 2] = _back(frame, (a0, a1, a2))


@inner
def _rotation(quat):
    """R_world_body row by row, nine numbers, of a unit quaternion."""
    x, y, z, w = quat
    return (
        1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w),
        2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w),
        2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y),
    )  # fmt: skip


@inner
def _turned_about_z(r, c, s):
    """R Rz: its columns, turned."""
    x0, y0 = turned(c, -s, r[0], r[1])
    x1, y1 = turned(c, -s, r[3], r[4])
    x2, y2 = turned(c, -s, r[6], r[7])
    return x0, y0, r[2], x1, y1, r[5], x2, y2, r[8]


@inner
def _turned_about_x(r, c, s):
    """R Rx."""
    y0, z0 = turned(c, -s, r[1], r[2])
    y1, z1 = turned(c, -s, r[4], r[5])
    y2, z2 = turned(c, -s, r[7], r[8])
    return r[0], y0, z0, r[3], y1, z1, r[6], y2, z2


@inner
def _apply(r, a):
    """R a."""
    return (
        r[0] * a[0] + r[1] * a[1] + r[2] * a[2],
        r[3] * a[0] + r[4] * a[1] + r[5] * a[2],
        r[6] * a[0] + r[7] * a[1] + r[8] * a[2],
    )


@inner
def _back(r, a):
    """R^T a."""
    return (
        r[0] * a[0] + r[3] * a[1] + r[6] * a[2],
        r[1] * a[0] + r[4] * a[1] + r[7] * a[2],
        r[2] * a[0] + r[5] * a[1] + r[8] * a[2],
    )
