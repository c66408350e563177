"""Quintic Hermite segments between knots, sampled to references."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array, PlannedDisturbance, Reference
from uvms_dynamics import Model, coupling_wrench, restoring_wrench
from uvms_dynamics.kernels.jit import kernel
from uvms_planner.problem import VEHICLE, yaw_quaternion
from uvms_planner.projection import tool_pose


@dataclass(frozen=True)
class Knot:
    """State of the planned motion between two steps."""

    stamp: int  # ns
    configuration: Array  # (m,) c = (x, y, z, psi, q)
    rate: Array  # (m,) dc/dt
    acceleration: Array  # (m,) d2c/dt2
    increment: Array  # (m,) c less that of the knot before

    @staticmethod
    def at_rest(stamp: int, configuration: Array) -> "Knot":
        """A knot that does not move."""
        zero = np.zeros_like(configuration)
        return Knot(stamp, configuration.copy(), zero, zero, zero)


@dataclass(frozen=True)
class Samples:
    """The configuration and its derivatives at k times."""

    configuration: Array  # (k, m)
    rate: Array  # (k, m)
    acceleration: Array  # (k, m)


def quintic(
    start: tuple[Array, Array, Array], end: tuple[Array, Array, Array], duration: float | Array
):
    """Coefficients (6, m) of c(t) = sum a_i t^i with given c, c_dot, c_ddot at both ends."""
    c0, v0, a0 = start
    c1, v1, a1 = end
    h = duration
    gap = c1 - c0 - v0 * h - 0.5 * a0 * h**2
    slope = (v1 - v0 - a0 * h) * h
    bend = (a1 - a0) * h**2
    return np.array(
        [
            c0,
            v0,
            0.5 * a0,
            (10 * gap - 4 * slope + 0.5 * bend) / h**3,
            (-15 * gap + 7 * slope - bend) / h**4,
            (6 * gap - 3 * slope + 0.5 * bend) / h**5,
        ]
    )


def evaluate(coefficients: Array, times: Array) -> Samples:
    """Value and two derivatives of the quintic with `coefficients` (6, m) at `times` (k,)."""
    t = times[:, None]
    one, zero = np.ones_like(t), np.zeros_like(t)
    value = np.hstack([one, t, t**2, t**3, t**4, t**5])
    first = np.hstack([zero, one, 2 * t, 3 * t**2, 4 * t**3, 5 * t**4])
    second = np.hstack([zero, zero, 2 * one, 6 * t, 12 * t**2, 20 * t**3])
    return Samples(value @ coefficients, first @ coefficients, second @ coefficients)


def hermite(start: Knot, end: Knot, duration: float, times: Array) -> Samples:
    """The segment from one knot to the next at `times` (k,) s after the first."""
    coefficients = quintic(
        (start.configuration, start.rate, start.acceleration),
        (end.configuration, end.rate, end.acceleration),
        duration,
    )
    return evaluate(coefficients, times)


def reference(model: Model, stamp: int, times: Array, samples: Samples) -> Reference:
    """The samples as the reference signal: body rates, quaternions, tool, self-disturbance.

    nu = R^T p_dot, r = psi_dot; nu_dot = R^T p_ddot - omega x nu, because nu is a body-frame
    vector of a turning body.
    """
    c, v, a = samples.configuration, samples.rate, samples.acceleration
    count = len(times)
    cos, sin = np.cos(c[:, 3]), np.sin(c[:, 3])
    quaternion = np.zeros((count, 4))
    quaternion[:, 2], quaternion[:, 3] = np.sin(c[:, 3] / 2), np.cos(c[:, 3] / 2)
    nu, nu_dot = np.zeros((count, 6)), np.zeros((count, 6))
    nu[:, 0] = cos * v[:, 0] + sin * v[:, 1]
    nu[:, 1] = -sin * v[:, 0] + cos * v[:, 1]
    nu[:, 2], nu[:, 5] = v[:, 2], v[:, 3]
    nu_dot[:, 0] = cos * a[:, 0] + sin * a[:, 1] + nu[:, 5] * nu[:, 1]
    nu_dot[:, 1] = -sin * a[:, 0] + cos * a[:, 1] - nu[:, 5] * nu[:, 0]
    nu_dot[:, 2], nu_dot[:, 5] = a[:, 2], a[:, 3]
    q, q_dot, q_ddot = (part[:, VEHICLE:].copy() for part in (c, v, a))
    wrenches = planned_wrenches(model, nu, nu_dot, q, q_dot, q_ddot)
    return Reference(
        stamp=stamp,
        times=times,
        position=c[:, :3].copy(),
        quaternion=quaternion,
        nu=nu,
        nu_dot=nu_dot,
        q=q,
        q_dot=q_dot,
        q_ddot=q_ddot,
        end_effector=tool_positions(model, c),
        disturbance=PlannedDisturbance(wrenches[:, 0].copy(), wrenches[:, 1].copy()),
    )


@kernel
def planned_wrenches(model, nu, nu_dot, q, q_dot, q_ddot):
    """Restoring and coupling wrench (k, 2, 6) on the level vehicle in still water, body frame.

    nu, nu_dot (k, 6); q, q_dot, q_ddot (k, n).
    """
    level = yaw_quaternion(0.0)
    out = np.empty((nu.shape[0], 2, 6))
    for i in range(nu.shape[0]):
        out[i, 0] = restoring_wrench(model, level, q[i])
        out[i, 1] = coupling_wrench(model, nu[i], nu_dot[i], q[i], q_dot[i], q_ddot[i])
    return out


@kernel
def tool_positions(model, configurations):
    """Positions (k, 3) of the tool in the world for configurations (k, m)."""
    out = np.zeros((configurations.shape[0], 3))
    for i in range(configurations.shape[0]):
        position, _ = tool_pose(model, configurations[i])
        for j in range(3):
            out[i, j] = position[j]
    return out
