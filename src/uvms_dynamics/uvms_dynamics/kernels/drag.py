"""Drag of the links, cylinder by cylinder: cross flow by strips and friction along the axis."""

import numpy as np
from numba.extending import overload

from uvms_dynamics.drag_table import FIRST_OCTAVE, LAST_OCTAVE, PER_OCTAVE_BITS
from uvms_dynamics.kernels.jit import OPTIONS, inner
from uvms_dynamics.kernels.layout import (
    AXIAL,
    AXIAL_AREA,
    AXIAL_REYNOLDS,
    AXIS,
    CELL_BITS,
    CELLS_A_ROW,
    CENTER,
    CROSS_FLOW,
    CROSS_REYNOLDS,
    DRAG_BEGIN,
    DRAG_END,
    HULL,
    STRIP,
    STRIPS,
)
from uvms_dynamics.kernels.lanes import LANES, LanesType, lane_of, with_lane
from uvms_dynamics.kernels.primitives import larger, root, size, smaller, zero_like
from uvms_dynamics.kernels.spatial import angular, cross, linear, load3, pair, plus, plus3

_LOWEST, _HIGHEST = 2.0**FIRST_OCTAVE, 2.0**LAST_OCTAVE
_SHIFT = np.int64(52 - PER_OCTAVE_BITS)  # a float64 has 52 bits of mantissa below its exponent
_BEFORE = np.int64((1023 + FIRST_OCTAVE) << PER_OCTAVE_BITS)  # 1023: the exponent's bias
_ONE, _IN_ROW = np.uint64(1), CELLS_A_ROW - np.uint64(1)


@inner
def link_drag(model, i, v):
    """Drag on link i about its frame's origin, from its motion through the water."""
    zero = zero_like(v[0])
    drag = (zero, zero, zero, zero, zero, zero)
    for row in range(np.uint64(model[i, DRAG_BEGIN]), np.uint64(model[i, DRAG_END])):
        drag = plus(drag, _cylinder_drag(model, row, v))
    return drag


@inner
def _cylinder_drag(model, row, v):
    """Drag of one cylinder.

    Across the axis df = -1/2 rho C_D(Re) D |u| u ds, with u the velocity of the strip at s across
    the axis and Re = |u| D / viscosity (section 2.2.1). Along it f = -1/2 rho C_f S |u_a| u_a
    with the wetted surface S: all strips move along the axis alike.
    """
    center, axis = load3(model, row, CENTER), load3(model, row, AXIS)
    u = plus3(linear(v), cross(angular(v), center))
    along = u[0] * axis[0] + u[1] * axis[1] + u[2] * axis[2]
    u = u[0] - along * axis[0], u[1] - along * axis[1], u[2] - along * axis[2]
    turn = cross(angular(v), axis)
    force, lever = _strip_drag(model, row, u, turn)
    first = np.uint64(model[HULL, AXIAL])
    friction = coefficient(model, first, model[row, AXIAL_REYNOLDS] * size(along))
    friction *= model[row, AXIAL_AREA] * size(along) * along
    force = (
        force[0] - friction * axis[0],
        force[1] - friction * axis[1],
        force[2] - friction * axis[2],
    )
    return pair(force, plus3(cross(center, force), cross(axis, lever)))


@inner
def _strip_drag(model, row, u, turn):
    """Sums of f and s f over the strips at s, whose velocity across the axis is u + s turn."""
    zero = zero_like(u[0])
    f0, f1, f2, g0, g1, g2 = zero, zero, zero, zero, zero, zero
    first, reynolds = np.uint64(model[HULL, CROSS_FLOW]), model[row, CROSS_REYNOLDS]
    for strip in range(np.int64(model[row, STRIPS])):
        k = STRIP + 2 * strip
        s = model[row, k]
        x0, x1, x2 = u[0] + s * turn[0], u[1] + s * turn[1], u[2] + s * turn[2]
        speed = root(x0 * x0 + x1 * x1 + x2 * x2)
        scale = model[row, k + 1] * (coefficient(model, first, reynolds * speed) * speed)
        f0, f1, f2 = f0 - scale * x0, f1 - scale * x1, f2 - scale * x2
        scale *= s
        g0, g1, g2 = g0 - scale * x0, g1 - scale * x1, g2 - scale * x2
    return (f0, f1, f2), (g0, g1, g2)


@inner
def coefficient(model, first, reynolds):
    """C(Re), linear in each cell of `drag_table`, constant beyond its ends."""
    inside = smaller(larger(reynolds, _LOWEST), _HIGHEST)
    a, b = cell_line(model, first, inside)
    return a + b * inside


@inner
def _cell_line(model, first, reynolds):
    """The line (a, b) of the cell in which a Reynolds number lies: its highest bits say which."""
    cell = np.uint64((np.float64(reynolds).view(np.int64) >> _SHIFT) - _BEFORE)
    row, column = first + (cell >> CELL_BITS), (cell & _IN_ROW) << _ONE
    return model[row, column], model[row, column + _ONE]


def cell_line(model, first, reynolds):
    """The same of a number or of lanes, each of which looks up its own."""


@overload(cell_line, jit_options=OPTIONS)
def _cell_line_of(model, first, reynolds):
    if not isinstance(reynolds, LanesType):
        return lambda model, first, reynolds: _cell_line(model, first, reynolds)

    def of_lanes(model, first, reynolds):
        a, b = reynolds, reynolds
        for lane in range(LANES):
            low, slope = _cell_line(model, first, lane_of(reynolds, lane))
            a, b = with_lane(a, lane, low), with_lane(b, lane, slope)
        return a, b

    return of_lanes
