"""A small closed loop for the tests of this package: exact sensors, held commands, RK4.

It is not the plant: it has no sensor noise, and thrusters only with a lag where a test asks for it.
"""

from dataclasses import dataclass

import numpy as np
from numba import njit

from uvms_control import ThrustAllocator
from uvms_core.signals import JointStates, Odometry, Reference, Wrench, to_nanoseconds
from uvms_dynamics import coupling_wrench, forward_dynamics, joint_passive_torque, restoring_wrench
from uvms_dynamics.kernels.rotations import quat_multiply, quat_normalize, quat_to_matrix

PERIOD = 0.05
SUBSTEPS = 10


@dataclass(frozen=True)
class State:
    """Pose, velocity and joints."""

    position: np.ndarray
    quaternion: np.ndarray
    nu: np.ndarray
    q: np.ndarray
    q_dot: np.ndarray

    def estimates(self, stamp):
        """Odometry and joint states as exact sensors would give them."""
        none = np.zeros((6, 6))
        odometry = Odometry(stamp, self.position, self.quaternion, self.nu, none, none)
        return odometry, JointStates(stamp, self.q, self.q_dot, np.zeros_like(self.q))

    def packed(self):
        return np.concatenate((self.position, self.quaternion, self.nu, self.q, self.q_dot))

    @classmethod
    def unpacked(cls, x):
        n = (x.size - 13) // 2
        return cls(x[:3], quat_normalize(x[3:7]), x[7:13], x[13 : 13 + n], x[13 + n :])


def at_rest(q, position=(0.0, 0.0, 0.0), quaternion=(0.0, 0.0, 0.0, 1.0)):
    q = np.array(q, dtype=float)
    return State(
        np.array(position, float), np.array(quaternion, float), np.zeros(6), q, np.zeros_like(q)
    )


@njit(cache=True)
def rates(model, x, tau):
    """Time derivative of the packed state under body wrench and joint torques `tau` (6+n,)."""
    n = (x.size - 13) // 2
    quaternion, nu, q, q_dot = x[3:7], x[7:13], x[13 : 13 + n], x[13 + n :]
    load = tau.copy()
    load[6:] += joint_passive_torque(model, q, q_dot)
    acceleration = forward_dynamics(model, quaternion, nu, q, q_dot, load)
    spin = np.zeros(4)
    spin[:3] = 0.5 * nu[3:]
    out = np.empty_like(x)
    out[:3] = quat_to_matrix(quaternion) @ nu[:3].copy()
    out[3:7] = quat_multiply(quaternion, spin)
    out[7:13] = acceleration[:6]
    out[13 : 13 + n] = q_dot
    out[13 + n :] = acceleration[6:]
    return out


@njit(cache=True)
def rk4(model, x, tau, h):
    """One Runge-Kutta step of h (s)."""
    k1 = rates(model, x, tau)
    k2 = rates(model, x + 0.5 * h * k1, tau)
    k3 = rates(model, x + 0.5 * h * k2, tau)
    k4 = rates(model, x + h * k3, tau)
    return x + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def observed(model, state, q_ddot):
    """Self-disturbance on the vehicle (16), by the model, from the exact state."""
    coupling = coupling_wrench(model, state.nu, np.zeros(6), state.q, state.q_dot, q_ddot)
    return restoring_wrench(model, state.quaternion, state.q) + coupling


def hold(q, position=(0.0, 0.0, 0.0), quaternion=(0.0, 0.0, 0.0, 1.0), tool=(0.0, 0.0, 0.0)):
    """A reference that stays where it is, at any time from 0 on."""
    n, six = len(q), np.zeros((1, 6))
    zero = np.zeros((1, n))
    return Reference(
        0, np.zeros(1), np.array([position], float), np.array([quaternion], float), six, six,
        np.array([q], float), zero, zero, np.array([tool], float),
    )  # fmt: skip


def quintic(t, duration):
    """Rest-to-rest share, rate and acceleration of a quintic at t."""
    s = min(max(t / duration, 0.0), 1.0)
    inside = 1.0 if 0.0 <= t <= duration else 0.0
    return (
        s**3 * (10 - 15 * s + 6 * s * s),
        inside * 30 * s * s * (1 - s) ** 2 / duration,
        inside * 60 * s * (1 - s) * (1 - 2 * s) / duration**2,
    )


def joint_motion(start, goal, duration, total):
    """A reference, sampled at the control period, that moves the joints while the vehicle holds."""
    start, goal = np.array(start), np.array(goal)
    times = np.arange(round(total / PERIOD) + 1) * PERIOD
    shares = np.array([quintic(t, duration) for t in times])
    k, way = times.size, goal - start
    rest = np.zeros((k, 6))
    return Reference(
        0, times, np.zeros((k, 3)), np.tile([0.0, 0.0, 0.0, 1.0], (k, 1)), rest, rest,
        start + shares[:, :1] * way, shares[:, 1:2] * way, shares[:, 2:] * way, np.zeros((k, 3)),
    )  # fmt: skip


def run(model, controller, state, reference, duration, *, allocator: ThrustAllocator | None = None,
        lag=0.0, noise=None, push=0.0, observer=None):  # fmt: skip
    """Close the loop for `duration` s; yields (time, state, wrench, effort) at every tick.

    `lag` (s): first-order lag of the achieved wrench; `noise(k, state)`: what the sensors see;
    `push` (6,): a wrench on the vehicle that nobody observes;
    `observer`: the model that the observer believes in.
    """
    actual = np.zeros(6)
    for k in range(round(duration / PERIOD) + 1):
        stamp = to_nanoseconds(k * PERIOD)
        seen = state if noise is None else noise(k, state)
        index = min(k, reference.times.size - 1)
        disturbance = Wrench(
            stamp, observed(model if observer is None else observer, seen, reference.q_ddot[index])
        )
        odometry, joints = seen.estimates(stamp)
        wrench, joint_command = controller.step(odometry, joints, disturbance, reference)
        yield k * PERIOD, state, wrench.wrench, joint_command.effort
        wanted = wrench.wrench if allocator is None else allocator.step(wrench)[1].achieved
        x = state.packed()
        for _ in range(SUBSTEPS):
            h = PERIOD / SUBSTEPS
            share = 1.0 if lag <= 0.0 else -np.expm1(-h / lag)
            actual = actual + share * (wanted - actual)
            x = rk4(model, x, np.concatenate((actual + push, joint_command.effort)), h)
        state = State.unpacked(x)
