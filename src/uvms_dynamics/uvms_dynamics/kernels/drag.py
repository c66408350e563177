"""Cross-flow drag of the links by strips, with each strip's own Reynolds number."""

import math

import numpy as np

from uvms_dynamics.drag_table import PER_OCTAVE_BITS
from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.spatial import cross

_SHIFT = 52 - PER_OCTAVE_BITS  # a float64 has 52 bits of mantissa below its exponent
_MASK = (1 << _SHIFT) - 1
_CELL = 1.0 / (1 << _SHIFT)


@inner
def link_drag(model, i, v0, v1, v2, w0, w1, w2):
    """Drag on link i (1..n) about its origin, from its motion through the water.

    Per strip f = -1/2 rho C_D(Re) D |v_n| v_n dl, v_n the strip's velocity across the axis and
    Re = |v_n| D / viscosity (section 2.2.1). The mean of a strip is taken at Gauss stations.
    """
    f0, f1, f2, n0, n1, n2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    place, axis, area = model.strip_position, model.strip_axis, model.strip_area
    for s in range(model.strip_start[i - 1], model.strip_start[i]):
        r0, r1, r2 = place[s, 0], place[s, 1], place[s, 2]
        a0, a1, a2 = axis[s, 0], axis[s, 1], axis[s, 2]
        c0, c1, c2 = cross(w0, w1, w2, r0, r1, r2)
        u0, u1, u2 = v0 + c0, v1 + c1, v2 + c2
        along = u0 * a0 + u1 * a1 + u2 * a2
        u0, u1, u2 = u0 - along * a0, u1 - along * a1, u2 - along * a2
        speed = math.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
        drag = _coefficient(model.drag_coefficient, model.drag_first, speed * area[s, 1])
        scale = -area[s, 0] * drag * speed
        d0, d1, d2 = scale * u0, scale * u1, scale * u2
        m0, m1, m2 = cross(r0, r1, r2, d0, d1, d2)
        f0, f1, f2 = f0 + d0, f1 + d1, f2 + d2
        n0, n1, n2 = n0 + m0, n1 + m1, n2 + m2
    return f0, f1, f2, n0, n1, n2


@inner
def _coefficient(table, first, reynolds):
    """C_D(Re), linear between the points of `drag_table`, constant beyond its ends."""
    bits = np.float64(reynolds).view(np.int64)
    k = (bits >> _SHIFT) - first
    if k < 0:
        return table[0]
    if k >= table.shape[0] - 1:
        return table[table.shape[0] - 1]
    part = float(bits & _MASK) * _CELL
    return table[k] + part * (table[k + 1] - table[k])
