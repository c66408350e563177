"""How far the tool is turned away from what a path prescribes: all of its axes, or one."""

import numpy as np

from uvms_dynamics.kernels.jit import inner, shared
from uvms_dynamics.kernels.rotations import matrix_to_quat, quat_to_rotation_vector
from uvms_planner.whole_path.tool_motion import tool_axes

WANTED_ROWS = 5
"""Of what is prescribed at an instant: the tool's rotation (three rows), an axis in the tool's own
axes, and the direction in which that axis is to point. Zero where it is free."""
AXIS, DIRECTION = 3, 4
OPPOSITE = 1e-9  # sine below which no turn between two directions is the shortest


@inner
def _any(row):
    return row[0] != 0.0 or row[1] != 0.0 or row[2] != 0.0


@shared
def tool_turn(model, frames, yaw, wanted, out):
    """Fill `out` (3,) with the rotation vector from the prescribed orientation to the tool's own.

    World axes, rad; its length is the angle between them. Of an axis it is the shortest turn, which
    is across the axis, so that turning about it is free. Zero where nothing is prescribed.
    frames (n + 1, 12) are those of `tool_motion`; wanted (WANTED_ROWS, 3).
    """
    for k in range(3):
        out[k] = 0.0
    if not (_any(wanted[0]) or _any(wanted[AXIS])):
        return
    turned = np.empty((3, 3))
    tool_axes(model, frames, frames.shape[0] - 1, yaw, turned)
    if _any(wanted[AXIS]):
        _shortest_turn(turned, wanted[AXIS], wanted[DIRECTION], out)
        return
    gap = np.zeros((3, 3))
    for row in range(3):
        for column in range(3):
            for k in range(3):
                gap[row, column] += turned[row, k] * wanted[column, k]
    vector = quat_to_rotation_vector(matrix_to_quat(gap))
    for k in range(3):
        out[k] = vector[k]


@inner
def _shortest_turn(turned, axis, direction, out):
    """Fill `out` (3,) with the turn from `direction` (3,) to turned @ axis, at most pi."""
    x = turned[0, 0] * axis[0] + turned[0, 1] * axis[1] + turned[0, 2] * axis[2]
    y = turned[1, 0] * axis[0] + turned[1, 1] * axis[1] + turned[1, 2] * axis[2]
    z = turned[2, 0] * axis[0] + turned[2, 1] * axis[1] + turned[2, 2] * axis[2]
    out[0] = direction[1] * z - direction[2] * y
    out[1] = direction[2] * x - direction[0] * z
    out[2] = direction[0] * y - direction[1] * x
    sine = np.sqrt(out[0] ** 2 + out[1] ** 2 + out[2] ** 2)
    cosine = direction[0] * x + direction[1] * y + direction[2] * z
    if sine > OPPOSITE:
        scale = np.arctan2(sine, cosine) / sine
        for k in range(3):
            out[k] *= scale
    elif cosine < 0.0:
        for k in range(3):
            out[k] = np.pi * turned[k, 0]  # any turn across the axis would do as well
