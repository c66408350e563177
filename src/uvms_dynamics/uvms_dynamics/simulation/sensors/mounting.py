"""True motion of the vehicle and of a sensor at a lever arm."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array, to_seconds
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.kernels.spatial import add_vectors, cross
from uvms_dynamics.simulation.integrator import QUATERNION, VELOCITY
from uvms_dynamics.simulation.water import Water
from uvms_dynamics.simulation.water.stream import stream_at
from uvms_dynamics.simulation.water.waves import wave_head

PLACE = slice(0, 3)
SPEED = slice(3, 6)
FORCE = slice(6, 9)
TURN = slice(9, 12)
"""Columns of `at_lever`: position in the world, velocity over ground, specific force and angular
velocity in the body frame."""


@dataclass(frozen=True)
class Trajectory:
    """True motion over some plant steps; states and rates are rows of the integrator."""

    stamps: tuple[int, ...]
    states: Array  # (k, nx)
    rates: Array  # (k, nx)
    current: Array  # (3,) velocity of the water in the world, its constant part
    water: Water | None = None  # what moves beside it

    def due(self, period: int) -> list[int]:
        """Rows whose stamp is a multiple of the period, ns."""
        return [row for row, stamp in enumerate(self.stamps) if stamp % period == 0]

    def at_lever(self, rows: list[int], lever: Array, gravity: float) -> Array:
        """Motion (k, 12) at a lever arm (3,) at some rows, columns as above."""
        which = np.array(rows, dtype=np.int64)
        motion = at_lever(self.states, self.rates, which, self.current, lever, gravity)
        if self.water is None or not rows:
            return motion
        times = np.array([to_seconds(self.stamps[row]) for row in rows])
        for row, moved, flow in zip(rows, motion, stream_at(self.water, times), strict=True):
            to_body = quat_to_matrix(self.states[row, QUATERNION:VELOCITY]).T
            moved[SPEED] += to_body @ flow[:3]
            moved[FORCE] += to_body @ flow[3:]
        return motion

    def wave_head(self, row: int, place: Array) -> float:
        """Pressure by waves at a place (3,) in the world, as metres of water."""
        if self.water is None or self.water.waves is None:
            return 0.0
        return float(wave_head(self.water.waves, place, to_seconds(self.stamps[row])))


@kernel
def at_lever(states, rates, rows, current, lever, gravity):
    """Position, velocity over ground, specific force and turn rate at a lever arm, (k, 12).

    v = v_o + omega x r and f = a_o + omega_dot x r + omega x (omega x r) - R^T g, with
    a_o = v_r_dot + omega x v_r in the frame of the current, which is inertial too.
    """
    out = np.empty((rows.shape[0], 12))
    arm = (lever[0], lever[1], lever[2])
    for k in range(rows.shape[0]):
        x, dx = states[rows[k]], rates[rows[k]]
        rotation = quat_to_matrix(x[QUATERNION:VELOCITY])
        v_r = (x[VELOCITY], x[VELOCITY + 1], x[VELOCITY + 2])
        turn = (x[VELOCITY + 3], x[VELOCITY + 4], x[VELOCITY + 5])
        speed = add_vectors(v_r, cross(turn, arm))
        turn_dot = (dx[VELOCITY + 3], dx[VELOCITY + 4], dx[VELOCITY + 5])
        force = add_vectors(cross(turn, speed), cross(turn_dot, arm))
        for i in range(3):
            place, drift = x[i], 0.0
            for j in range(3):
                place += rotation[i, j] * arm[j]
                drift += rotation[j, i] * current[j]
            out[k, i] = place
            out[k, 3 + i] = speed[i] + drift
            out[k, 6 + i] = dx[VELOCITY + i] + force[i] - rotation[2, i] * gravity
            out[k, 9 + i] = turn[i]
    return out
