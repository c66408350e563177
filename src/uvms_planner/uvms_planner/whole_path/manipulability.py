"""How far the arm is from a singular posture: Yoshikawa's measure for the tool's position.

w = sqrt(det(J J^T)), J (3, n) the tool's velocity relative to the vehicle per joint rate
(Yoshikawa 1985, "Manipulability of robotic mechanisms", eq. (14)). It is the volume of the
ellipsoid of velocities, but for a constant, and zero where the tool cannot be moved in some
direction. Of an arm of less than three joints w = sqrt(det(J^T J)).
"""

from functools import lru_cache

import numpy as np
from scipy.optimize import minimize

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.layout import INERTIA, NET_MOMENT
from uvms_planner.whole_path.posture_range import spread_postures
from uvms_planner.whole_path.tool_motion import FRAME_COLUMNS, ORIGIN, tool_motion

POSTURES_LOG2 = 10  # of the postures among which the best is looked for
CLIMBS = 4  # from the best of them
REMEMBERED = 8  # arms and ranges


@inner
def manipulability_at(frames, tool):
    """W in m^min(n, 3), from frames (n + 1, 12) and the tool's position (3,) of `tool_motion`."""
    xx, yy, zz, xy, xz, yz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    n = frames.shape[0] - 1
    for i in range(1, n + 1):
        rx = tool[0] - frames[i, ORIGIN]
        ry = tool[1] - frames[i, ORIGIN + 1]
        rz = tool[2] - frames[i, ORIGIN + 2]
        x = frames[i, 5] * rz - frames[i, 8] * ry
        y = frames[i, 8] * rx - frames[i, 2] * rz
        z = frames[i, 2] * ry - frames[i, 5] * rx
        xx, yy, zz = xx + x * x, yy + y * y, zz + z * z
        xy, xz, yz = xy + x * y, xz + x * z, yz + y * z
    if n == 1:
        return np.sqrt(xx + yy + zz)
    if n == 2:
        minors = xx * yy - xy * xy + xx * zz - xz * xz + yy * zz - yz * yz
        return np.sqrt(max(minors, 0.0))
    whole = xx * (yy * zz - yz * yz) - xy * (xy * zz - yz * xz) + xz * (xy * yz - yy * xz)
    return np.sqrt(max(whole, 0.0))


@kernel
def manipulability(model, postures):
    """W (k,) of joint positions (k, n) in rad."""
    n = postures.shape[1]
    frames, tool = np.empty((n + 1, FRAME_COLUMNS)), np.empty((3, 3))
    motion, out = np.zeros((3, n + 1)), np.empty(postures.shape[0])
    for k in range(postures.shape[0]):
        for i in range(n):
            motion[0, 1 + i] = postures[k, i]
        tool_motion(model, motion, frames, tool)
        out[k] = manipulability_at(frames, tool[0])
    return out


def best_manipulability(model: Model, lower: Array, upper: Array) -> float:
    """The greatest W that the arm has with its joints between `lower` and `upper` (n,) rad.

    From evenly spread postures uphill, always the same ones; good to a thousandth or so.
    """
    table = _kinematics(model, len(lower))
    return _best(table.tobytes(), table.shape, *(np.array(b).tobytes() for b in (lower, upper)))


def _kinematics(model: Model, n: int) -> Array:
    """The model without masses and weights, which a payload changes."""
    table = model.copy()
    table[: n + 1, INERTIA : NET_MOMENT + 3] = 0.0
    return table


@lru_cache(maxsize=REMEMBERED)
def _best(table: bytes, shape: tuple[int, ...], low: bytes, high: bytes) -> float:
    model = np.frombuffer(table).reshape(shape).copy()  # kernels take what may be written
    lower, upper = np.frombuffer(low), np.frombuffer(high)
    postures = spread_postures(lower, upper, POSTURES_LOG2)
    found = manipulability(model, postures)
    bounds = list(zip(lower, upper, strict=True))

    def less(q: Array) -> float:
        return -float(manipulability(model, q[None])[0])

    starts = postures[np.argsort(-found, kind="stable")[:CLIMBS]]
    return max(-float(minimize(less, start, bounds=bounds).fun) for start in starts)
