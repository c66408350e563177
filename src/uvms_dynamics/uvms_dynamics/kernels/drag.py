"""Drag of the links, cylinder by cylinder: cross flow by strips and friction along the axis."""

import numpy as np

from uvms_dynamics.drag_table import FIRST_OCTAVE, LAST_OCTAVE, PER_OCTAVE_BITS
from uvms_dynamics.kernels.arithmetic import root, size, zero_like
from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import (
    AXIAL,
    AXIAL_AREA,
    AXIAL_REYNOLDS,
    AXIS,
    CENTER,
    COEFFICIENT_BITS,
    COEFFICIENTS_A_ROW,
    CROSS_FLOW,
    CROSS_REYNOLDS,
    DRAG_BEGIN,
    DRAG_END,
    HULL,
    STRIP,
    STRIPS,
)
from uvms_dynamics.kernels.spatial import cross, load3

_SHIFT = 52 - PER_OCTAVE_BITS  # a float64 has 52 bits of mantissa below its exponent
_MASK = (1 << _SHIFT) - 1
_CELL = 1.0 / (1 << _SHIFT)
_FIRST = (1023 + FIRST_OCTAVE) << PER_OCTAVE_BITS  # 1023: the exponent's bias
_LAST = (LAST_OCTAVE - FIRST_OCTAVE) << PER_OCTAVE_BITS


@inner
def link_drag(model, i, v0, v1, v2, w0, w1, w2):
    """Drag (f, n) on link i about its frame's origin, from its motion through the water."""
    f0, f1, f2 = zero_like(v0), zero_like(v0), zero_like(v0)
    n0, n1, n2 = zero_like(v0), zero_like(v0), zero_like(v0)
    for row in range(int(model[i, DRAG_BEGIN]), int(model[i, DRAG_END])):
        g0, g1, g2, m0, m1, m2 = _cylinder_drag(model, row, v0, v1, v2, w0, w1, w2)
        f0, f1, f2, n0, n1, n2 = f0 + g0, f1 + g1, f2 + g2, n0 + m0, n1 + m1, n2 + m2
    return f0, f1, f2, n0, n1, n2


@inner
def _cylinder_drag(model, row, v0, v1, v2, w0, w1, w2):
    """Drag of one cylinder.

    Across the axis df = -1/2 rho C_D(Re) D |u| u ds, with u the velocity of the strip at s across
    the axis and Re = |u| D / viscosity (section 2.2.1). Along it f = -1/2 rho C_f S |u_a| u_a
    with the wetted surface S: all strips move along the axis alike.
    """
    c0, c1, c2 = load3(model, row, CENTER)
    a0, a1, a2 = load3(model, row, AXIS)
    u0, u1, u2 = cross(w0, w1, w2, c0, c1, c2)
    u0, u1, u2 = v0 + u0, v1 + u1, v2 + u2
    along = u0 * a0 + u1 * a1 + u2 * a2
    u0, u1, u2 = u0 - along * a0, u1 - along * a1, u2 - along * a2
    t0, t1, t2 = cross(w0, w1, w2, a0, a1, a2)
    f0, f1, f2 = zero_like(v0), zero_like(v0), zero_like(v0)
    g0, g1, g2 = zero_like(v0), zero_like(v0), zero_like(v0)
    first, reynolds = int(model[HULL, CROSS_FLOW]), model[row, CROSS_REYNOLDS]
    for k in range(STRIP, STRIP + 2 * int(model[row, STRIPS]), 2):
        s = model[row, k]
        x0, x1, x2 = u0 + s * t0, u1 + s * t1, u2 + s * t2
        speed = root(x0 * x0 + x1 * x1 + x2 * x2)
        scale = model[row, k + 1] * coefficient(model, first, reynolds * speed) * speed
        f0, f1, f2 = f0 - scale * x0, f1 - scale * x1, f2 - scale * x2
        scale *= s
        g0, g1, g2 = g0 - scale * x0, g1 - scale * x1, g2 - scale * x2
    speed = size(along)
    friction = coefficient(model, int(model[HULL, AXIAL]), model[row, AXIAL_REYNOLDS] * speed)
    friction *= model[row, AXIAL_AREA] * speed * along
    f0, f1, f2 = f0 - friction * a0, f1 - friction * a1, f2 - friction * a2
    n0, n1, n2 = cross(c0, c1, c2, f0, f1, f2)
    m0, m1, m2 = cross(a0, a1, a2, g0, g1, g2)
    return f0, f1, f2, n0 + m0, n1 + m1, n2 + m2


@inner
def coefficient(model, first, reynolds):
    """C(Re), linear between the points of `drag_table`, constant beyond its ends."""
    bits = np.float64(reynolds).view(np.int64)
    k = (bits >> _SHIFT) - _FIRST
    if k < 0:
        return model[first, 0]
    if k >= _LAST:
        return model[first + (_LAST >> COEFFICIENT_BITS), _LAST & (COEFFICIENTS_A_ROW - 1)]
    part = float(bits & _MASK) * _CELL
    low = model[first + (k >> COEFFICIENT_BITS), k & (COEFFICIENTS_A_ROW - 1)]
    k += 1
    high = model[first + (k >> COEFFICIENT_BITS), k & (COEFFICIENTS_A_ROW - 1)]
    return low + part * (high - low)
