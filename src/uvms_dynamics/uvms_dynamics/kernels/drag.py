"""Cross-flow drag of the links by strips, with each strip's own Reynolds number."""

import math

import numpy as np

from uvms_dynamics.drag_table import FIRST_OCTAVE, PER_OCTAVE_BITS
from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.kernels.layout import STRIP_AREA, STRIP_AXIS, STRIP_PLACE, STRIP_REYNOLDS
from uvms_dynamics.kernels.spatial import cross, load3

_SHIFT = 52 - PER_OCTAVE_BITS  # a float64 has 52 bits of mantissa below its exponent
_MASK = (1 << _SHIFT) - 1
_CELL = 1.0 / (1 << _SHIFT)
_FIRST = (1023 + FIRST_OCTAVE) << PER_OCTAVE_BITS  # 1023: the exponent's bias


@inner
def strip_drag(strips, coefficient, s, v0, v1, v2, w0, w1, w2):
    """Drag on strip s about its link's origin, from the link's motion through the water.

    f = -1/2 rho C_D(Re) D |v_n| v_n dl, v_n the strip's velocity across the axis and
    Re = |v_n| D / viscosity (section 2.2.1).
    """
    r0, r1, r2 = load3(strips, s, STRIP_PLACE)
    a0, a1, a2 = load3(strips, s, STRIP_AXIS)
    c0, c1, c2 = cross(w0, w1, w2, r0, r1, r2)
    u0, u1, u2 = v0 + c0, v1 + c1, v2 + c2
    along = u0 * a0 + u1 * a1 + u2 * a2
    u0, u1, u2 = u0 - along * a0, u1 - along * a1, u2 - along * a2
    speed = math.sqrt(u0 * u0 + u1 * u1 + u2 * u2)
    drag = drag_coefficient(coefficient, speed * strips[s, STRIP_REYNOLDS])
    scale = -strips[s, STRIP_AREA] * drag * speed
    d0, d1, d2 = scale * u0, scale * u1, scale * u2
    m0, m1, m2 = cross(r0, r1, r2, d0, d1, d2)
    return d0, d1, d2, m0, m1, m2


@inner
def drag_coefficient(table, reynolds):
    """C_D(Re), linear between the points of `drag_table`, constant beyond its ends."""
    bits = np.float64(reynolds).view(np.int64)
    k = (bits >> _SHIFT) - _FIRST
    if k < 0:
        return table[0]
    if k >= table.shape[0] - 1:
        return table[table.shape[0] - 1]
    part = float(bits & _MASK) * _CELL
    return table[k] + part * (table[k + 1] - table[k])
