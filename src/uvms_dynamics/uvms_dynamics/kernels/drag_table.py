"""The drag coefficient, resampled so that numba kernels look it up without logarithm or search."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.arm import DragCoefficient

PER_OCTAVE_BITS = 4
PER_OCTAVE = 1 << PER_OCTAVE_BITS
"""Points in each doubling of the Reynolds number; within them C_D is linear in Re.

The top bits of a float64 are its exponent and mantissa, so they are the index of its cell. Against
the file's table, linear in ln Re, the resampled one is off by less than 0.1 per cent, and by up to
3 per cent in a cell that bridges a sharp corner such as the drag crisis.
"""

FIRST_OCTAVE, LAST_OCTAVE = -10, 30
"""The table covers Re = 2**FIRST_OCTAVE to 2**LAST_OCTAVE, 0.001 to 1.07e9; what is below has no
drag to speak of, and no file goes beyond."""

CELLS = (LAST_OCTAVE - FIRST_OCTAVE) * PER_OCTAVE + 1
"""Cells of the table; the last one holds the constant beyond it."""


def resample(coefficient: DragCoefficient) -> tuple[Array, Array]:
    """Reynolds numbers (k,) and C_D (k,); constant beyond the file's ends."""
    steps = np.arange(CELLS)
    nodes = 2.0 ** (FIRST_OCTAVE + steps // PER_OCTAVE)
    nodes = nodes * (1.0 + (steps % PER_OCTAVE) / PER_OCTAVE)
    values = np.interp(np.log(nodes), np.log(coefficient.reynolds), coefficient.cd)
    return nodes, values


def cell_lines(coefficient: DragCoefficient) -> Array:
    """(CELLS, 2): a and b of C_D = a + b Re in each cell."""
    nodes, values = resample(coefficient)
    slopes = np.diff(values) / np.diff(nodes)
    inside = np.column_stack([values[:-1] - slopes * nodes[:-1], slopes])
    return np.vstack([inside, [values[-1], 0.0]])
