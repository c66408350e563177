"""A smooth curve through points in time, from rest to rest, and turns between orientations."""

from itertools import pairwise

import numpy as np
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import Array, PathGoal


def dense_times(times: Array, spacing: float) -> Array:
    """Times (k,) among which `times` (n,) are, exactly, at most `spacing` s apart."""
    parts = [
        np.linspace(before, after, max(1, int(np.ceil((after - before) / spacing))), endpoint=False)
        for before, after in pairwise(times)
    ]
    return np.concatenate([*parts, times[-1:]])


def through(times: Array, points: Array, wanted: Array) -> Array:
    """The curve through `points` (n, 3) at `times` (n,), at `wanted` (k,) s; (k, 3).

    It is that of the planner, `EndEffectorPath`, so that points mean the same whoever gives them. A
    spline would be smoother by one derivative and swing out by metres where times are uneven.
    """
    found = EndEffectorPath(PathGoal(times, points, np.zeros((0, 4)))).positions(wanted)
    found[np.searchsorted(wanted, times)] = points  # exactly, not to the rounding of polynomials
    return found


def turned(times: Array, rotations: Rotation, wanted: Array) -> Array:
    """Quaternions (k, 4) at `wanted` (k,): from each rotation the shorter way to the next.

    As `through`: at rest at both ends, where two follow each other that are equal, and nowhere
    else.
    """
    points = np.zeros((len(times), 3))
    found = EndEffectorPath(PathGoal(times, points, rotations.as_quat())).samples(wanted).quaternion
    assert found is not None  # the goal has orientations
    return found
