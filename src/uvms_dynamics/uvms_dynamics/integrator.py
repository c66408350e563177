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
from uvms_dynamics.kernels.workspace import Workspace, make_workspace
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

    work: Workspace
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
    last = states.shape[0] - 1
    for s in range(last + 1):
        for stage in range(4):
            _stage_state(x, stage, step, scratch)
            _derivative(system, thrust_command, effort, scratch, scratch.stage, stage)
            if stage == 0:
                for k in range(x.shape[0]):
                    states[s, k] = x[k]
                    rates[s, k] = scratch.stage[0, k]
                if s == last:
                    return
        _combine_stages(x, step, scratch)


@inner
def _stage_state(x, stage, step, scratch):
    """State at which the stage's derivative is taken."""
    part = 0.0 if stage == 0 else (step if stage == 3 else 0.5 * step)
    before = max(stage - 1, 0)
    for k in range(x.shape[0]):
        change = part * scratch.stage[before, k] if stage > 0 else 0.0
        scratch.trial[k] = x[k] + change


@inner
def _combine_stages(x, step, scratch):
    """One Runge-Kutta step of x; its quaternion is made unit again."""
    stage = scratch.stage
    for k in range(x.shape[0]):
        x[k] += step / 6.0 * (stage[0, k] + 2.0 * (stage[1, k] + stage[2, k]) + stage[3, k])
    _unit_quaternion(x, scratch.quat)
    for k in range(4):
        x[QUATERNION + k] = scratch.quat[k]


@inner
def _derivative(system, thrust_command, effort, scratch, table, row):
    """Derivative of the state scratch.trial, into a row of the table."""
    n, m = effort.shape[0], thrust_command.shape[0]
    x, out = scratch.trial, table[row]
    q, q_dot, thrust = x[JOINTS : JOINTS + n], x[JOINTS + n : JOINTS + 2 * n], x[JOINTS + 2 * n :]
    _unit_quaternion(x, scratch.quat)
    _pose_rates(system.current, scratch.quat, x, out)
    _generalized_force(system, q, q_dot, thrust, effort, scratch.tau)
    forward_dynamics_into(
        system.model,
        scratch.quat,
        x[VELOCITY:JOINTS],
        q,
        q_dot,
        scratch.tau,
        scratch.work,
        scratch.acceleration,
    )
    for k in range(6):
        out[VELOCITY + k] = scratch.acceleration[k]
    for i in range(n):
        out[JOINTS + i] = q_dot[i]
        out[JOINTS + n + i] = scratch.acceleration[6 + i]
    for i in range(m):
        out[JOINTS + 2 * n + i] = thrust_rate(system.thrusters, i, thrust[i], thrust_command[i])


@inner
def _unit_quaternion(x, out):
    """Unit quaternion (4,) of the state; Runge-Kutta stages leave the unit sphere a little."""
    a, b, c, d = x[QUATERNION], x[QUATERNION + 1], x[QUATERNION + 2], x[QUATERNION + 3]
    scale = 1.0 / math.sqrt(a * a + b * b + c * c + d * d)
    out[0], out[1], out[2], out[3] = scale * a, scale * b, scale * c, scale * d


@inner
def _pose_rates(current, quat, x, out):
    """p_dot = R v_r + v_c and the quaternion's rate 1/2 quat (omega, 0)."""
    a, b, c, d = quat[0], quat[1], quat[2], quat[3]
    u, v, w = x[VELOCITY], x[VELOCITY + 1], x[VELOCITY + 2]
    p, q, r = x[VELOCITY + 3], x[VELOCITY + 4], x[VELOCITY + 5]
    # R v = v + 2 e x (e x v + d v), with e the vector part
    t0, t1, t2 = b * w - c * v + d * u, c * u - a * w + d * v, a * v - b * u + d * w
    out[0] = u + 2.0 * (b * t2 - c * t1) + current[0]
    out[1] = v + 2.0 * (c * t0 - a * t2) + current[1]
    out[2] = w + 2.0 * (a * t1 - b * t0) + current[2]
    out[QUATERNION] = 0.5 * (d * p + b * r - c * q)
    out[QUATERNION + 1] = 0.5 * (d * q + c * p - a * r)
    out[QUATERNION + 2] = 0.5 * (d * r + a * q - b * p)
    out[QUATERNION + 3] = -0.5 * (a * p + b * q + c * r)


@inner
def _generalized_force(system, q, q_dot, thrust, effort, tau):
    """Body wrench of the thrusters and torque of drives, friction and stops on the joints."""
    matrix = system.thrusters.matrix
    for k in range(6):
        total = 0.0
        for i in range(thrust.shape[0]):
            total += matrix[k, i] * thrust[i]
        tau[k] = total
    for i in range(effort.shape[0]):
        tau[6 + i] = effort[i] + passive_torque(system.model, i, q[i], q_dot[i])
