"""The floating vehicle under a prescribed motion of its arm: hybrid dynamics.

The joints follow given q(t), q_dot(t), q_ddot(t) with any torque that this takes; the base is free:

    nu_dot = M_bb(q)^-1 (tau - ID(nu_dot = 0, q_ddot)[:6]),

with ID the inverse dynamics of the whole system (Featherstone 2008, sec. 9.2; Fossen's nu). The
water is still, so that nu_r = nu.
"""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_dynamics.kernels import inverse_dynamics, mass_matrix
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.motion import down_in_body
from uvms_dynamics.kernels.spatial import spatial_at
from uvms_dynamics.model.vehicle_table import Model
from uvms_dynamics.simulation.integrator import DEPTH, VELOCITY, pose_rates
from uvms_dynamics.simulation.tether import load_wrench, tether_load

STATE = 13
"""Position (3,) and quaternion (4,) in the world, velocity (6,) in the body frame."""


class PrescribedJoints(NamedTuple):
    """The arm's motion over m steps: rows at the beginning, the middle and the end of each step."""

    steps: Array  # (m,) s
    q: Array  # (2m+1, n) rad
    q_dot: Array  # (2m+1, n)
    q_ddot: Array  # (2m+1, n)


class Load(NamedTuple):
    """A weight (N, down) and its first moment (3,) about the body origin, besides the tether's.

    A part of the moment fades away: moment_fading exp(-t / fading_time).
    """

    weight: float = 0.0
    moment: Array = np.zeros(3)  # N m: position times weight, body frame
    moment_fading: Array = np.zeros(3)
    fading_time: float = 1.0  # s


def float_freely(model: Model, start: Array, motion: PrescribedJoints, load: Load) -> Array:
    """States (m+1, 13) from the state `start` (13,), by classical Runge-Kutta steps."""
    table = np.array([[load.weight, *load.moment], [0.0, *load.moment_fading]])
    inverse = np.linalg.inv(base_inertia(model, motion.q))
    out = np.empty((len(motion.steps) + 1, STATE))
    out[0] = start
    _integrate(model, table, load.fading_time, inverse, motion, out)
    return out


@kernel
def base_inertia(model, q):
    """M_bb (rows, 6, 6) of the system with its joints locked, for each row of q (rows, n)."""
    out = np.empty((q.shape[0], 6, 6))
    for row in range(q.shape[0]):
        out[row] = mass_matrix(model, q[row])[:6, :6]
    return out


@kernel
def base_acceleration(model, load, inverse, x, q, q_dot, q_ddot):
    """nu_dot (6,) of the base at the state x (13,); load (4,) is weight and first moment."""
    quat = x[3:7]
    needed = inverse_dynamics(model, quat, x[7:], np.zeros(6), q, q_dot, q_ddot)
    down = down_in_body(quat[0], quat[1], quat[2], quat[3])
    wrench = load_wrench(load, down)
    tau = -needed[:6]
    out = np.zeros(6)
    for i in range(6):
        tau[i] += wrench[i]
    for i in range(6):
        for j in range(6):
            out[i] += inverse[i, j] * tau[j]
    return out


@kernel
def _integrate(model, loads, fading_time, inverse, motion, states):
    steps, q, q_dot, q_ddot = motion
    n = q.shape[1]
    t = 0.0
    slope = np.empty((4, 13))
    trial = np.empty(13)
    for s in range(steps.shape[0]):
        h = steps[s]
        for k in range(4):
            row = 2 * s + (k + 1) // 2
            trial[:] = states[s]
            if k > 0:
                trial += (h if k == 3 else 0.5 * h) * slope[k - 1]
            trial[3:7] /= np.sqrt(np.sum(trial[3:7] ** 2))
            rates = pose_rates(spatial_at(trial, VELOCITY), trial[3], trial[4], trial[5], trial[6])
            for i in range(7):
                slope[k, i] = rates[i]
            at = t + 0.5 * h * ((k + 1) // 2)
            load = loads[0] + np.array(tether_load(model, n, trial[DEPTH]))
            load += loads[1] * np.exp(-at / fading_time)
            slope[k, 7:] = base_acceleration(
                model, load, inverse[row], trial, q[row], q_dot[row], q_ddot[row]
            )
        total = slope[0] + 2.0 * (slope[1] + slope[2]) + slope[3]
        states[s + 1] = states[s] + h / 6.0 * total
        t += h
        states[s + 1, 3:7] /= np.sqrt(np.sum(states[s + 1, 3:7] ** 2))
