"""The uniform part of the moving water in the kernels: its velocity V(t) and acceleration A(t).

The state's frame moves with it. A body of mass m and displaced mass rho V feels in this frame
-m A, and from the pressure that accelerates the water rho V A (Froude-Krylov): together a gravity
that is g - A instead of g, for weight and buoyancy alike. Added mass sees relative motion only.

Where there is nothing but a constant current, `water` is None and none of this is compiled.
"""

import math

import numpy as np
from numba import types
from numba.extending import overload

from uvms_dynamics.kernels.arithmetic import sine_cosine
from uvms_dynamics.kernels.jit import OPTIONS, inner, kernel
from uvms_dynamics.kernels.numba_internals.primitives import maximum, minimum
from uvms_dynamics.kernels.spatial import cross, load3

HALF_TURN = math.pi


@inner
def stream(water, time):
    """V (m/s) and A (m/s^2) of harmonics and gusts at a time, s, six numbers in the world."""
    v0, v1, v2, a0, a1, a2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(water.harmonics.shape[0]):
        w = water.harmonics[i, 0]
        c, s = load3(water.harmonics, i, 1), load3(water.harmonics, i, 4)
        sine, cosine = sine_cosine(w * time)
        v0, v1, v2 = (
            v0 + c[0] * cosine + s[0] * sine,
            v1 + c[1] * cosine + s[1] * sine,
            v2 + c[2] * cosine + s[2] * sine,
        )
        a0, a1, a2 = (
            a0 + w * (s[0] * cosine - c[0] * sine),
            a1 + w * (s[1] * cosine - c[1] * sine),
            a2 + w * (s[2] * cosine - c[2] * sine),
        )
    for i in range(water.gusts.shape[0]):
        share, rate = _gust_share(water.gusts, i, time)
        g = load3(water.gusts, i, 3)
        v0, v1, v2 = v0 + share * g[0], v1 + share * g[1], v2 + share * g[2]
        a0, a1, a2 = a0 + rate * g[0], a1 + rate * g[1], a2 + rate * g[2]
    return v0, v1, v2, a0, a1, a2


@inner
def _gust_share(gusts, i, time):
    """Share of a gust's velocity at a time, (1 - cos(pi x)) / 2 in its rise, and its rate, 1/s."""
    per_rise = gusts[i, 2]
    up, down = (time - gusts[i, 0]) * per_rise, (gusts[i, 1] - time) * per_rise
    x = minimum(maximum(minimum(up, down), 0.0), 1.0)
    sine, cosine = sine_cosine(HALF_TURN * x)
    sign = 1.0 if up < down else -1.0
    return 0.5 * (1.0 - cosine), sign * 0.5 * HALF_TURN * per_rise * sine


@kernel
def stream_at(water, times):
    """V and A (k, 6) at times (k,), for Python; water is not None."""
    out = np.empty((times.shape[0], 6))
    for k in range(times.shape[0]):
        v0, v1, v2, a0, a1, a2 = stream(water, times[k])
        out[k, 0], out[k, 1], out[k, 2] = v0, v1, v2
        out[k, 3], out[k, 4], out[k, 5] = a0, a1, a2
    return out


def stream_of(water, time):
    """V and A as of `stream`; None where water is None."""


def carried(current, moving):
    """Velocity (3 numbers) in the world of the frame that the state is relative to."""


def apparent_down(water, moving, quat, down):
    """Down in body axes, as weight and buoyancy act in that frame: R^T (g - A) / |g|."""


@overload(stream_of, jit_options=OPTIONS)
def _stream_of(water, time):
    if isinstance(water, types.NoneType):
        return lambda water, time: None
    return lambda water, time: stream(water, time)


@overload(carried, jit_options=OPTIONS)
def _carried(current, moving):
    if isinstance(moving, types.NoneType):
        return lambda current, moving: (current[0], current[1], current[2])
    return lambda current, moving: (
        current[0] + moving[0],
        current[1] + moving[1],
        current[2] + moving[2],
    )


@overload(apparent_down, jit_options=OPTIONS)
def _apparent_down(water, moving, quat, down):
    if isinstance(moving, types.NoneType):
        return lambda water, moving, quat, down: down
    return _tilted_down


def _tilted_down(water, moving, quat, down):
    a0, a1, a2 = world_to_body(quat, (moving[3], moving[4], moving[5]))
    inverse = 1.0 / water.gravity
    return down[0] - inverse * a0, down[1] - inverse * a1, down[2] - inverse * a2


@inner
def world_to_body(quat, v):
    """R^T v = v + 2 e x (e x v - d v) with the unit quaternion (e, d)."""
    e = quat[0], quat[1], quat[2]
    d = quat[3]
    t0, t1, t2 = cross(e, v)
    x0, x1, x2 = cross(e, (t0 - d * v[0], t1 - d * v[1], t2 - d * v[2]))
    return v[0] + 2.0 * x0, v[1] + 2.0 * x1, v[2] + 2.0 * x2
