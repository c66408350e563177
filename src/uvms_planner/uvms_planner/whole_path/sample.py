"""What the plan costs and needs at one instant, from the posture's motion and the tool's path.

The posture s = (psi, q) of the level vehicle and the tool's position y decide the vehicle's
position, p = y - Rz(psi) r(q), r the tool in the body frame; so the tool is exactly on its path
at every instant.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics import coupling_wrench, inverse_dynamics, restoring_wrench
from uvms_dynamics.kernels.clearance import clearance_work, clearances_into
from uvms_dynamics.kernels.jit import inner, shared
from uvms_planner.problem import yaw_quaternion
from uvms_planner.whole_path.manipulability import manipulability_at
from uvms_planner.whole_path.tool_motion import FRAME_COLUMNS, tool_motion
from uvms_planner.whole_path.tool_turn import AXIS, DIRECTION, tool_turn

WRENCHES = 12  # restoring and coupling wrench
POSITION = WRENCHES  # of the vehicle, then its velocity and acceleration, world axes
ATTITUDE = POSITION + 9  # roll and pitch that the vehicle takes up freely
TURN = ATTITUDE + 2  # from the prescribed orientation of the tool, or of an axis, to its own
MANIPULABILITY = TURN + 3  # of the arm
THRUST = MANIPULABILITY + 1  # share of each thruster's authority, then clearances
STEP = 1e-6  # of a finite difference, rad, rad/s, rad/s^2


class Target(NamedTuple):
    """The tool's path at k instants."""

    position: Array  # (k, 3) m
    velocity: Array  # (k, 3) m/s
    acceleration: Array  # (k, 3) m/s^2
    rotation: Array  # (k, 3, 3) tool to map_ned; (0, 3, 3) where it is free
    axis: Array  # (3,) of the tool, in its own axes, that is to point somewhere; or zero
    direction: Array  # (k, 3) where it is to point, map_ned; (0, 3) where it is free


class Surroundings(NamedTuple):
    """What decides the thrust that a motion needs, and what the vehicle must keep clear of."""

    shares: Array  # (thrusters, 6) share of each thruster's limit per unit of wrench
    current: Array  # (3,) m/s, map_ned
    shapes: Array  # of `uvms_dynamics.geometry`
    margins: Array  # (pairs,) m, least clearances; none: they do not count


NO_SURROUNDINGS = Surroundings(np.zeros((0, 6)), np.zeros(3), np.zeros((1, 1)), np.zeros(0))
"""Neither thrusters nor bodies limit a plan."""
NEAR_M = 0.15
"""A clearance of this much more than its margin is as good as any."""


@inner
def read_aim(target, i, aim, wanted):
    """Fill `aim` (3, 3) and `wanted` (WANTED_ROWS, 3) with the target at instant i.

    numba counts the references of all arrays of a tuple that it hands on, so that what is called
    for every derivative takes arrays.
    """
    oriented, points = target.rotation.shape[0] > 0, target.direction.shape[0] > 0
    for k in range(3):
        aim[0, k], aim[1, k] = target.position[i, k], target.velocity[i, k]
        aim[2, k] = target.acceleration[i, k]
        for m in range(3):
            wanted[k, m] = target.rotation[i, k, m] if oriented else 0.0
        wanted[AXIS, k] = target.axis[k] if points else 0.0
        wanted[DIRECTION, k] = target.direction[i, k] if points else 0.0


@inner
def vehicle_motion(model, motion, aim, frames, tool, out):
    """Fill `out` (3, 3): position, velocity and acceleration of the vehicle, world axes.

    aim (3, 3) has those of the tool in its rows.
    """
    tool_motion(model, motion, frames, tool)
    c, s = np.cos(motion[0, 0]), np.sin(motion[0, 0])
    w, bend = motion[1, 0], motion[2, 0]
    x, y = tool[0, 0], tool[0, 1]
    vx, vy = tool[1, 0] - w * y, tool[1, 1] + w * x
    ax = tool[2, 0] - bend * y - w * (tool[1, 1] + vy)
    ay = tool[2, 1] + bend * x + w * (tool[1, 0] + vx)
    out[0, 0] = aim[0, 0] - (c * x - s * y)
    out[0, 1] = aim[0, 1] - (s * x + c * y)
    out[1, 0] = aim[1, 0] - (c * vx - s * vy)
    out[1, 1] = aim[1, 1] - (s * vx + c * vy)
    out[2, 0] = aim[2, 0] - (c * ax - s * ay)
    out[2, 1] = aim[2, 1] - (s * ax + c * ay)
    out[0, 2] = aim[0, 2] - tool[0, 2]
    out[1, 2] = aim[1, 2] - tool[1, 2]
    out[2, 2] = aim[2, 2] - tool[2, 2]


@inner
def _body_motion(motion, vehicle, nu, nu_dot):
    """Nu and nu_dot (6,) of the level vehicle: nu_dot = R^T p_ddot - omega x nu."""
    c, s, w = np.cos(motion[0, 0]), np.sin(motion[0, 0]), motion[1, 0]
    nu[0] = c * vehicle[1, 0] + s * vehicle[1, 1]
    nu[1] = -s * vehicle[1, 0] + c * vehicle[1, 1]
    nu[2], nu[5] = vehicle[1, 2], w
    nu_dot[0] = c * vehicle[2, 0] + s * vehicle[2, 1] + w * nu[1]
    nu_dot[1] = -s * vehicle[2, 0] + c * vehicle[2, 1] - w * nu[0]
    nu_dot[2], nu_dot[5] = vehicle[2, 2], motion[2, 0]


@shared
def sample_values(
    model, shares, current, shapes, margins, motion, aim, wanted, moved, thrust, close, out
):
    """Fill `out` with all values of one instant; those of the posture alone only if `moved`.

    motion (3, d): posture, rates, accelerations. `aim` and `wanted` of `read_aim`. `thrust`,
    `close`: whether the thrusters' shares and the clearances count. The four arrays after `model`
    are those of `Surroundings`.
    """
    n = motion.shape[1] - 1
    frames, tool = np.empty((n + 1, FRAME_COLUMNS)), np.empty((3, 3))
    vehicle = np.empty((3, 3))
    nu, nu_dot = np.zeros(6), np.zeros(6)
    vehicle_motion(model, motion, aim, frames, tool, vehicle)
    _body_motion(motion, vehicle, nu, nu_dot)
    q, q_dot, q_ddot = motion[0, 1:], motion[1, 1:], motion[2, 1:]
    coupling = coupling_wrench(model, nu, nu_dot, q, q_dot, q_ddot)
    for k in range(6):
        out[6 + k] = coupling[k]
    for row in range(3):
        for k in range(3):
            out[POSITION + 3 * row + k] = vehicle[row, k]
    if moved:
        _posture_values(model, motion[0], wanted, frames, tool[0], out)
    if thrust:
        _thrust_shares(model, shares, current, motion, nu, nu_dot, out)
    if close and moved:
        _clearances(model, shapes, margins, motion, vehicle, out[THRUST + shares.shape[0] :])


@shared
def _posture_values(model, posture, wanted, frames, tool, out):
    """Restoring wrench, free attitude, the tool's turn and manipulability: no rate changes them."""
    q = posture[1:]
    quaternion = np.zeros(4)
    quaternion[3] = 1.0
    level = restoring_wrench(model, quaternion, q)
    quaternion[0] = quaternion[3] = np.sqrt(0.5)
    rolled = restoring_wrench(model, quaternion, q)
    for k in range(6):
        out[k] = level[k]
    x, y, z = -level[4], level[3], -rolled[3]
    out[ATTITUDE], out[ATTITUDE + 1] = np.arctan2(y, z), np.arctan2(-x, np.hypot(y, z))
    tool_turn(model, frames, posture[0], wanted, out[TURN:MANIPULABILITY])
    out[MANIPULABILITY] = manipulability_at(frames, tool)


@shared
def _thrust_shares(model, shares, current, motion, nu, nu_dot, out):
    """Share of each thruster's limit that the motion needs, by the least squares of all."""
    c, s, w = np.cos(motion[0, 0]), np.sin(motion[0, 0]), motion[1, 0]
    x = c * current[0] + s * current[1]
    y = -s * current[0] + c * current[1]
    nu[0], nu[1], nu[2] = nu[0] - x, nu[1] - y, nu[2] - current[2]
    nu_dot[0], nu_dot[1] = nu_dot[0] - w * y, nu_dot[1] + w * x
    level = yaw_quaternion(0.0)
    needed = inverse_dynamics(model, level, nu, nu_dot, motion[0, 1:], motion[1, 1:], motion[2, 1:])
    for k in range(shares.shape[0]):
        total = 0.0
        for j in range(6):
            total += shares[k, j] * needed[j]
        out[THRUST + k] = abs(total)


@inner
def _clearances(model, shapes, margins, motion, vehicle, out):
    """Clearance of each pair, m, as far as it matters."""
    c, s = np.cos(motion[0, 0]), np.sin(motion[0, 0])
    clearances_into(
        model, shapes, (vehicle[0, 0], vehicle[0, 1], vehicle[0, 2]),
        (c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0), motion[0, 1:],
        clearance_work(model, shapes), out,
    )  # fmt: skip
    for k in range(margins.shape[0]):
        out[k] = min(out[k], margins[k] + NEAR_M)


@shared
def sample_jacobian(
    model, shares, current, shapes, margins, motion, aim, wanted, thrust, close, base, moved, out
):
    """Fill `out` (values, 3 d) with the derivatives of all values by forward differences."""
    d, clear = motion.shape[1], THRUST + shares.shape[0]
    for row in range(3):
        for column in range(d):
            kept = motion[row, column]
            motion[row, column] = kept + STEP
            sample_values(
                model, shares, current, shapes, margins, motion, aim, wanted, row == 0, thrust,
                close, moved,
            )  # fmt: skip
            motion[row, column] = kept
            for k in range(base.shape[0]):
                still = row > 0 and (k < 6 or ATTITUDE <= k < THRUST or k >= clear)
                out[k, row * d + column] = 0.0 if still else (moved[k] - base[k]) / STEP
