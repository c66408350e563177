"""Loops in compiled code around the kernels, as in a simulation: no calls from Python.

Everything that the benchmarks use beyond the public functions of `uvms_dynamics` is here.
"""

from collections.abc import Callable

import numpy as np
from motions import Motion
from numba import njit

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model
from uvms_dynamics.kernels.forward import forward_dynamics_into
from uvms_dynamics.kernels.motion import make_workspace
from uvms_dynamics.simulation import CurrentConfig, advance_batch, make_system
from uvms_dynamics.simulation.integrator import advance, make_scratch

STEP_S = 0.005
STEPS = 50
"""Runge-Kutta steps in one call of `stepping`."""

BATCH_STEPS = 5
"""Runge-Kutta steps of each simulation in one call of `stepping_batch`."""

THRUST_N = 2.0
CURRENT = CurrentConfig(constant_ned_m_s=(0.2, -0.1, 0.0))


@njit(cache=True)
def _forward_all(model, quat, nu, q, q_dot, tau, out):
    """Forward dynamics of every motion; one workspace for all."""
    work = make_workspace(model)
    for i in range(quat.shape[0]):
        forward_dynamics_into(model, quat[i], nu[i], q[i], q_dot[i], tau[i], work, out[i])


def forward_loop(model: Model, motions: list[Motion]) -> tuple[Callable[[], None], Array]:
    """A call that computes all motions' accelerations, and the table (k, 6+n) that it fills."""
    columns = [np.array([getattr(m, k) for m in motions]) for k in Motion._fields]
    quat, nu, _, q, q_dot, _, tau = columns
    out = np.empty_like(tau)
    return lambda: _forward_all(model, quat, nu, q, q_dot, tau, out), out


def stepping(
    vehicle: Vehicle, motion: Motion, halvings: int = 0, current: CurrentConfig = CURRENT
) -> Callable[[], Array]:
    """A call that makes STEPS Runge-Kutta steps from a motion; returns the last state.

    With `halvings` it makes more and shorter ones for the same time. The whole plant: thrusters
    with lag, friction, end stops; states and rates are recorded.
    """
    steps, step = STEPS * 2**halvings, STEP_S / 2**halvings
    system, start = make_system(vehicle, current), _state(vehicle, motion)
    scratch, thrust = make_scratch(system), np.full(vehicle.n_thrusters, THRUST_N)
    effort = motion.tau[6:].copy()
    states, rates = np.empty((2, steps + 1, len(start)))
    state = start.copy()

    def work() -> Array:
        state[:] = start
        advance(tuple(system), state, thrust, effort, step, tuple(scratch), states, rates, 0.0)
        return state

    return work


def stepping_batch(vehicle: Vehicle, motions: list[Motion]) -> Callable[[], Array]:
    """A call that makes BATCH_STEPS steps from each of many motions; returns their last states."""
    system = make_system(vehicle, CURRENT)
    starts = np.array([_state(vehicle, motion) for motion in motions])
    thrust = np.full((len(motions), vehicle.n_thrusters), THRUST_N)
    effort = np.array([motion.tau[6:] for motion in motions])
    return lambda: advance_batch(system, starts, thrust, effort, STEP_S, BATCH_STEPS)


def _state(vehicle: Vehicle, motion: Motion) -> Array:
    """State of the integrator with this motion and no thrust."""
    idle = np.zeros(vehicle.n_thrusters)
    parts = [np.zeros(3), motion.quat, motion.nu, motion.q, motion.q_dot, idle]
    return np.concatenate(parts)
