"""Drag of the links: cross flow over cylinders by strips, and friction along their axes.

The cylinders of an arm are independent of each other, so a single simulation works on eight of them
at once: its links leave their velocities in slots, eight cylinders to a group, and fetch forces
from there. Many simulations at once take one cylinder after the other. Both use `_cylinder_drag`.
"""

import numpy as np
from numba import types
from numba.extending import overload

from uvms_dynamics.kernels.drag_table import FIRST_OCTAVE, LAST_OCTAVE, PER_OCTAVE_BITS
from uvms_dynamics.kernels.jit import OPTIONS, inner
from uvms_dynamics.kernels.layout import (
    AXIAL,
    AXIAL_AREA,
    AXIAL_REYNOLDS,
    AXIS,
    CENTER,
    CROSS_FLOW,
    CROSS_REYNOLDS,
    CYLINDERS,
    DRAG_BEGIN,
    DRAG_END,
    FORCE,
    GROUPS,
    HULL,
    JOINTS,
    STRIP,
    STRIPS,
    WORK_COLUMNS,
)
from uvms_dynamics.kernels.numba_internals.lanes import (
    LANES,
    LaneArrayType,
    LanesType,
    lane_of,
    lanes_at,
    put_lanes,
    with_lane,
)
from uvms_dynamics.kernels.numba_internals.primitives import (
    fabs,
    maximum,
    minimum,
    read,
    sqrt,
    write,
    zero_like,
)
from uvms_dynamics.kernels.spatial import (
    add_vectors,
    angular,
    cross,
    linear,
    load6,
    minus,
    pair,
    store_spatial,
)

_LOWEST, _HIGHEST = 2.0**FIRST_OCTAVE, 2.0**LAST_OCTAVE
_SHIFT = np.int64(52 - PER_OCTAVE_BITS)  # a float64 has 52 bits of mantissa below its exponent
_BEFORE = np.int64((1023 + FIRST_OCTAVE) << PER_OCTAVE_BITS)  # 1023: the exponent's bias
SLOT_NUMBERS = 12  # of a cylinder: velocity of its link, then force on it


def gather_drag(model, work, i, v):
    """Note the velocity of link i, whose drag `apply_drag` adds to FORCE."""


def apply_drag(model, work):
    """Add the drag of all links, as a resistance, to their FORCE."""


@overload(gather_drag, jit_options=OPTIONS)
def _gather_drag(model, work, i, v):
    if isinstance(work, LaneArrayType):
        return _add_drag
    return _store_velocity


@overload(apply_drag, jit_options=OPTIONS)
def _apply_drag(model, work):
    if isinstance(work, LaneArrayType):
        return lambda model, work: None
    return _apply_drag_by_groups


def _add_drag(model, work, i, v):
    strips, block = np.int64(model[HULL, STRIPS]), np.int64(model[HULL, CYLINDERS])
    stride = LANES * (STRIP + 2 * strips)
    force = load6(work, i, FORCE)
    for slot in range(np.int64(model[i, DRAG_BEGIN]), np.int64(model[i, DRAG_END])):
        group, lane = slot // LANES, slot % LANES
        force = minus(force, _cylinder_drag(model, block + group * stride, strips, lane, v))
    store_spatial(work, i, FORCE, force)


def _store_velocity(model, work, i, v):
    for slot in range(np.uint64(model[i, DRAG_BEGIN]), np.uint64(model[i, DRAG_END])):
        first = _slot(model, slot)
        for k in range(6):
            write(work, first + LANES * k, v[k])


def _apply_drag_by_groups(model, work):
    strips, block = np.int64(model[HULL, STRIPS]), np.int64(model[HULL, CYLINDERS])
    stride = LANES * (STRIP + 2 * strips)
    n, slots = np.int64(model[HULL, JOINTS]), _slot(model, 0)
    for group in range(np.int64(model[HULL, GROUPS])):
        first = slots + LANES * SLOT_NUMBERS * group
        v = _spatial_in_slot(work, first, None)
        force = _cylinder_drag(model, block + group * stride, strips, None, v)
        for k in range(6):
            put_lanes(work, first + LANES * (6 + k), force[k])
    for i in range(1, n + 1):
        force = load6(work, i, FORCE)
        for slot in range(np.uint64(model[i, DRAG_BEGIN]), np.uint64(model[i, DRAG_END])):
            force = minus(force, _spatial_in_slot(work, _slot(model, slot) + 6 * LANES, 0))
        store_spatial(work, i, FORCE, force)


@inner
def _slot(model, slot):
    """First item of a slot in the workspace, behind the rows of the bodies."""
    bodies = (np.int64(model[HULL, JOINTS]) + 1) * WORK_COLUMNS
    group, lane = np.uint64(slot) // np.uint64(LANES), np.uint64(slot) % np.uint64(LANES)
    return bodies + np.int64(np.uint64(LANES * SLOT_NUMBERS) * group + lane)


@inner
def _spatial_in_slot(work, block, lane):
    """Motion or force of a slot, or of all eight of a group where lane is None."""
    return (
        _value(work, block, 0, lane),
        _value(work, block, 1, lane),
        _value(work, block, 2, lane),
        _value(work, block, 3, lane),
        _value(work, block, 4, lane),
        _value(work, block, 5, lane),
    )


@inner
def _cylinder_drag(model, block, strips, lane, v):
    """Drag of one cylinder of a group, or of all eight (lane is None), about the link's origin.

    Across the axis df = -1/2 rho C_D(Re) D |u| u ds, with u the velocity of the strip at s across
    the axis and Re = |u| D / viscosity (section 2.2.1). Along it f = -1/2 rho C_f S |u_a| u_a
    with the wetted surface S: all strips move along the axis alike.
    """
    center, axis = _vector_of(model, block, CENTER, lane), _vector_of(model, block, AXIS, lane)
    u = add_vectors(linear(v), cross(angular(v), center))
    along = _dot(u, axis)
    u = u[0] - along * axis[0], u[1] - along * axis[1], u[2] - along * axis[2]
    turn = cross(angular(v), axis)
    sum0, sum1, sum2 = _strip_sums(model, block, strips, lane, u, turn)
    friction = _value(model, block, AXIAL_AREA, lane) * fabs(along) * along
    reynolds = _value(model, block, AXIAL_REYNOLDS, lane) * fabs(along)
    friction *= coefficient(model, np.int64(model[HULL, AXIAL]), reynolds)
    force = (
        -(u[0] * sum0 + turn[0] * sum1 + friction * axis[0]),
        -(u[1] * sum0 + turn[1] * sum1 + friction * axis[1]),
        -(u[2] * sum0 + turn[2] * sum1 + friction * axis[2]),
    )
    lever = (
        -(u[0] * sum1 + turn[0] * sum2),
        -(u[1] * sum1 + turn[1] * sum2),
        -(u[2] * sum1 + turn[2] * sum2),
    )
    return pair(force, add_vectors(cross(center, force), cross(axis, lever)))


@inner
def _strip_sums(model, block, strips, lane, u, turn):
    """Sums of k, s k and s^2 k over the strips at s, each with the force -k (u + s turn)."""
    slip, mixed, spin = _dot(u, u), 2.0 * _dot(u, turn), _dot(turn, turn)
    first, per_speed = (
        np.int64(model[HULL, CROSS_FLOW]),
        _value(model, block, CROSS_REYNOLDS, lane),
    )
    sum0, sum1, sum2 = zero_like(u[0]), zero_like(u[0]), zero_like(u[0])
    for strip in range(strips):
        s = _value(model, block, STRIP + 2 * strip, lane)
        area = _value(model, block, STRIP + 2 * strip + 1, lane)
        speed = sqrt(maximum(slip + s * (mixed + s * spin), 0.0))  # rounding may go below zero
        k = area * (coefficient(model, first, per_speed * speed) * speed)
        sum0, sum1, sum2 = sum0 + k, sum1 + s * k, sum2 + s * (s * k)
    return sum0, sum1, sum2


@inner
def _dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@inner
def _vector_of(model, block, k, lane):
    """A vector of a cylinder."""
    return (
        _value(model, block, k, lane),
        _value(model, block, k + 1, lane),
        _value(model, block, k + 2, lane),
    )


def _value(table, block, k, lane):
    """Number k of a cylinder or slot, or of all eight of a group where lane is None."""


@overload(_value, jit_options=OPTIONS)
def _value_overload(table, block, k, lane):
    if isinstance(lane, types.NoneType):
        return lambda table, block, k, lane: lanes_at(table, block + LANES * k)
    return lambda table, block, k, lane: read(table, block + LANES * k + lane)


@inner
def coefficient(model, first, reynolds):
    """C(Re), linear in each cell of `drag_table`, constant beyond its ends."""
    inside = minimum(maximum(reynolds, _LOWEST), _HIGHEST)
    a, b = _cell_line(model, first, inside)
    return a + b * inside


def _cell_line(model, first, reynolds):
    """The line (a, b) of the cell in which a Reynolds number lies: by its highest bits."""


@overload(_cell_line, jit_options=OPTIONS)
def _cell_line_overload(model, first, reynolds):
    if isinstance(reynolds, LanesType):
        return _cell_lines
    return _one_cell_line


def _one_cell_line(model, first, reynolds):
    cell = first + 2 * ((np.float64(reynolds).view(np.int64) >> _SHIFT) - _BEFORE)
    return read(model, cell), read(model, cell + 1)


def _cell_lines(model, first, reynolds):
    a, b = reynolds, reynolds
    for lane in range(LANES):
        low, slope = _cell_line(model, first, lane_of(reynolds, lane))
        a, b = with_lane(a, lane, low), with_lane(b, lane, slope)
    return a, b
