"""The complete plant as one ordinary differential equation, and its fixed-step integrator.

State x (13 + 2n + m,): position (3,) and quaternion (4,) in the world, velocity nu_r (6,) relative
to the water in the body frame, q (n,), q_dot (n,), thrust (m,). The current is constant and
uniform, so the frame that moves with it is inertial: dynamics in nu_r, p_dot = R v_r + v_c.
"""

import math
from typing import NamedTuple

import numpy as np

from uvms_dynamics.kernels.forward import forward_dynamics_into
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.joints import passive_torque
from uvms_dynamics.kernels.motion import make_workspace
from uvms_dynamics.model import Model
from uvms_dynamics.signals import Array
from uvms_dynamics.thrusters import Thrusters, thrust_rate

POSITION, QUATERNION, VELOCITY, JOINTS = 0, 3, 7, 13
"""Where each part of the state begins; q_dot at JOINTS + n, thrust at JOINTS + 2n."""


class System(NamedTuple):
    """What the derivative of the state depends on besides state and commands."""

    model: Model
    thrusters: Thrusters
    current: Array  # (3,) velocity of the water in the world


class Scratch(NamedTuple):
    """Tables that the integrator needs, allocated once."""

    work: Array  # of the kernels
    quat: Array  # (4,)
    tau: Array  # (6+n,)
    acceleration: Array  # (6+n,)
    stage: Array  # (4, nx) derivatives of the Runge-Kutta stages
    trial: Array  # (nx,)


def make_scratch(n: int, m: int) -> Scratch:
    """Scratch tables for n joints and m thrusters."""
    size = JOINTS + 2 * n + m
    return Scratch(
        make_workspace(n),
        np.empty(4),
        np.empty(6 + n),
        np.empty(6 + n),
        np.empty((4, size)),
        np.empty(size),
    )


@kernel
def advance(system, x, thrust_command, effort, step, scratch, states, rates):
    """Integrate by classical Runge-Kutta steps of `step` s under constant commands.

    x (nx,) becomes the state at the end. Row k of states (steps+1, nx) is the state after k steps
    and row k of rates its derivative under these commands: thrust (m,) N, joint torque (n,) N m.
    """
    n, m = effort.shape[0], thrust_command.shape[0]
    model, current = system.model, system.current
    matrix, limit, lag, slew = system.thrusters
    work, quat, tau, acceleration, stage, trial = scratch
    nu_r, q, q_dot = trial[VELOCITY:JOINTS], trial[JOINTS : JOINTS + n], trial[JOINTS + n :][:n]
    thrust = trial[JOINTS + 2 * n :]
    last = states.shape[0] - 1
    for s in range(last + 1):
        for k in range(4):
            _stage_state(x, stage, trial, k, step)
            _unit_quaternion(trial, quat)
            _pose_rates(current, quat, trial, stage, k)
            _generalized_force(matrix, model.joints, q, q_dot, thrust, effort, tau)
            forward_dynamics_into(model, quat, nu_r, q, q_dot, tau, work, acceleration)
            _velocity_rates(acceleration, q_dot, stage, k)
            for i in range(m):
                rate = thrust_rate(limit, lag, slew, i, thrust[i], thrust_command[i])
                stage[k, JOINTS + 2 * n + i] = rate
            if k == 0:
                _record(x, stage, states, rates, s)
                if s == last:
                    return
        _combine_stages(x, stage, quat, step)


@inner
def _record(x, stage, states, rates, s):
    """Rows s: the state and its derivative (slices would drag in numba's text formatting)."""
    for i in range(x.shape[0]):
        states[s, i] = x[i]
        rates[s, i] = stage[0, i]


@inner
def _stage_state(x, stage, trial, k, step):
    """State at which the derivative of stage k is taken."""
    if k == 0:
        for i in range(x.shape[0]):
            trial[i] = x[i]
    else:
        part = step if k == 3 else 0.5 * step
        for i in range(x.shape[0]):
            trial[i] = x[i] + part * stage[k - 1, i]


@inner
def _combine_stages(x, stage, quat, step):
    """One Runge-Kutta step of x; its quaternion is made unit again."""
    for i in range(x.shape[0]):
        x[i] += step / 6.0 * (stage[0, i] + 2.0 * (stage[1, i] + stage[2, i]) + stage[3, i])
    _unit_quaternion(x, quat)
    for i in range(4):
        x[QUATERNION + i] = quat[i]


@inner
def _unit_quaternion(x, out):
    """Unit quaternion (4,) of the state; Runge-Kutta stages leave the unit sphere a little."""
    a, b, c, d = x[QUATERNION], x[QUATERNION + 1], x[QUATERNION + 2], x[QUATERNION + 3]
    scale = 1.0 / math.sqrt(a * a + b * b + c * c + d * d)
    out[0], out[1], out[2], out[3] = scale * a, scale * b, scale * c, scale * d


@inner
def _pose_rates(current, quat, x, out, k):
    """Row k of out: p_dot = R v_r + v_c and the quaternion's rate 1/2 quat (omega, 0)."""
    a, b, c, d = quat[0], quat[1], quat[2], quat[3]
    u, v, w = x[VELOCITY], x[VELOCITY + 1], x[VELOCITY + 2]
    p, q, r = x[VELOCITY + 3], x[VELOCITY + 4], x[VELOCITY + 5]
    # R v = v + 2 e x (e x v + d v), with e the vector part
    t0, t1, t2 = b * w - c * v + d * u, c * u - a * w + d * v, a * v - b * u + d * w
    out[k, 0] = u + 2.0 * (b * t2 - c * t1) + current[0]
    out[k, 1] = v + 2.0 * (c * t0 - a * t2) + current[1]
    out[k, 2] = w + 2.0 * (a * t1 - b * t0) + current[2]
    out[k, QUATERNION] = 0.5 * (d * p + b * r - c * q)
    out[k, QUATERNION + 1] = 0.5 * (d * q + c * p - a * r)
    out[k, QUATERNION + 2] = 0.5 * (d * r + a * q - b * p)
    out[k, QUATERNION + 3] = -0.5 * (a * p + b * q + c * r)


@inner
def _generalized_force(matrix, joints, q, q_dot, thrust, effort, tau):
    """Body wrench of the thrusters and torque of drives, friction and stops on the joints."""
    for k in range(6):
        total = 0.0
        for i in range(thrust.shape[0]):
            total += matrix[k, i] * thrust[i]
        tau[k] = total
    for i in range(effort.shape[0]):
        tau[6 + i] = effort[i] + passive_torque(joints, i + 1, q[i], q_dot[i])


@inner
def _velocity_rates(acceleration, q_dot, out, k):
    """Row k of out: rates of nu_r, q and q_dot."""
    n = q_dot.shape[0]
    for i in range(6):
        out[k, VELOCITY + i] = acceleration[i]
    for i in range(n):
        out[k, JOINTS + i] = q_dot[i]
        out[k, JOINTS + n + i] = acceleration[6 + i]
