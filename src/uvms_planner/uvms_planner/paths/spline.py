"""A smooth curve through points in time, from rest to rest, and turns between orientations."""

from itertools import pairwise

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array
from uvms_planner.paths.timing import quintic

AT_REST = [(1, np.zeros(3)), (2, np.zeros(3))]
"""No velocity and no acceleration."""


def dense_times(times: Array, spacing: float) -> Array:
    """Times (k,) among which `times` (n,) are, exactly, at most `spacing` s apart."""
    parts = [
        np.linspace(before, after, max(1, int(np.ceil((after - before) / spacing))), endpoint=False)
        for before, after in pairwise(times)
    ]
    return np.concatenate([*parts, times[-1:]])


def through(times: Array, points: Array, wanted: Array) -> Array:
    """The quintic spline through `points` (n, 3) at `times` (n,), at `wanted` (k,); (k, 3).

    Velocity and acceleration are zero at both ends and continuous in between (C4).
    """
    # Measured in mean intervals: the powers of large times would spoil the equations.
    unit = float(times[-1] - times[0]) / (len(times) - 1)
    curve = make_interp_spline(times / unit, points, k=5, bc_type=(AT_REST, AT_REST))
    found = curve(wanted / unit)
    given = np.searchsorted(wanted, times)
    found[given] = points  # exactly, not to the rounding of the equations
    return found


def turned(times: Array, rotations: Rotation, wanted: Array) -> Array:
    """Quaternions (k, 4) at `wanted` (k,): from each rotation the shorter way to the next.

    Each turn begins and ends at rest, u = 10 x^3 - 15 x^4 + 6 x^5, x the share of its time.
    """
    index = np.clip(np.searchsorted(times, wanted, side="right") - 1, 0, len(times) - 2)
    share = quintic((wanted - times[index]) / (times[index + 1] - times[index]))
    arcs = (rotations[1:] * rotations[:-1].inv()).as_rotvec()
    return (Rotation.from_rotvec(share[:, None] * arcs[index]) * rotations[index]).as_quat()
