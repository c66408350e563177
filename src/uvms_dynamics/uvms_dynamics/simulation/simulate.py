"""Simulations of a vehicle over time: one with all its states, or many at once."""

import operator

import numpy as np

from uvms_core.errors import ConfigError
from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import kernel
from uvms_dynamics.kernels.layout import FIRST, HULL, JOINTS, WORK_COLUMNS
from uvms_dynamics.kernels.numba_internals.lanes import LANES, lane_table, lane_vector
from uvms_dynamics.simulation.integrator import (
    System,
    advance,
    derivative,
    finish_step,
    make_scratch,
    state_size,
)


def simulate(
    system: System,
    x: Array,
    thrust_command: Array,
    effort: Array,
    step: float,
    steps: int,
    start_s: float = 0.0,
) -> Array:
    """States (steps+1, nx) from the state x (nx,) on, by Runge-Kutta steps of `step` s.

    `integrator` defines the layout of the state; `make_state` makes one. thrust_command (m,) N and
    effort (n,) N m are constant; x is the state at start_s, which counts where the water's motion
    depends on time. Raises ConfigError for shapes, a step or a number of
    steps that do not fit. It does not check that the step is stable; `Plant` does.
    """
    _check_length(step, steps)
    start, thrust, torque = _fitting(system, x, thrust_command, effort, ())
    states = np.empty((steps + 1, len(start)))
    rates, scratch = np.empty_like(states), make_scratch(system)
    tables = tuple(scratch), states, rates
    advance(tuple(system), start, thrust, torque, float(step), *tables, float(start_s))
    return states


def advance_batch(
    system: System, x: Array, thrust_command: Array, effort: Array, step: float, steps: int
) -> Array:
    """States (b, nx) of b simulations after `steps` Runge-Kutta steps of `step` s.

    x (b, nx) are their states, thrust_command (b, m) N and effort (b, n) N m their constant
    commands; vehicle and current are common to all, and the current is constant. Each result is
    that of `simulate` up to rounding. One thread, eight simulations in a vector of the processor:
    1024 take less than half the time that they take one by one. Raises ConfigError as `simulate`
    does, and for a current that is not constant.
    """
    _check_length(step, steps)
    if system.water is not None:
        raise ConfigError("system: its water moves; advance_batch knows constant currents only")
    out, thrust, torque = _fitting(system, x, thrust_command, effort, (len(x),))
    _advance_groups(*system[:3], system.push, out, thrust, torque, float(step), steps)
    return out


def _check_length(step: float, steps: int) -> None:
    if operator.index(steps) < 0:
        raise ConfigError(f"steps: {steps} is negative; must be a whole number >= 0")
    if not 0.0 < step < np.inf:
        raise ConfigError(f"step: {step:g} s; must be finite and > 0")


def _fitting(
    system: System, x: Array, thrust_command: Array, effort: Array, batch: tuple[int, ...]
) -> tuple[Array, Array, Array]:
    """The arrays as the kernels need them, x a copy; the kernels do not check bounds."""
    state = np.array(x, dtype=float, order="C")
    thrust, torque = (np.ascontiguousarray(a, dtype=float) for a in (thrust_command, effort))
    n, m = int(system.model[HULL, JOINTS]), len(system.thrusters)
    for name, array, shape in (
        ("x", state, (*batch, state_size(system))),
        ("thrust_command", thrust, (*batch, m)),
        ("effort", torque, (*batch, n)),
        ("current", system.current, (3,)),
    ):
        if array.shape != shape:
            raise ConfigError(f"{name}: has shape {array.shape}, needs {shape}")
    return state, thrust, torque


@kernel
def _advance_groups(model, thrusters, current, push, x, thrust_command, effort, step, steps):
    n, m, count = effort.shape[1], thrust_command.shape[1], x.shape[0]
    lanes_x, lanes_trial = np.empty((x.shape[1], LANES)), np.empty((x.shape[1], LANES))
    lanes_thrust, lanes_effort = np.empty((m, LANES)), np.empty((n, LANES))
    lanes_stage = np.empty((4, x.shape[1], LANES))
    lanes_work = np.empty((n + 1, WORK_COLUMNS, LANES))
    state, trial = lane_vector(lanes_x), lane_vector(lanes_trial)
    thrust, torque = lane_vector(lanes_thrust), lane_vector(lanes_effort)
    stage, work = lane_table(lanes_stage), lane_table(lanes_work)
    for first in range(0, count, LANES):
        _take(x, first, lanes_x)
        _take(thrust_command, first, lanes_thrust)
        _take(effort, first, lanes_effort)
        for _ in range(steps):
            derivative(
                model, thrusters, current, None, push, 0.0, n, m,
                state, thrust, torque, work, None, stage, FIRST,
            )  # fmt: skip
            finish_step(
                model, thrusters, current, None, push, 0.0, n, m,
                state, thrust, torque, step, work, None, stage, trial,
            )  # fmt: skip
        for lane in range(min(LANES, count - first)):
            for k in range(x.shape[1]):
                x[first + lane, k] = lanes_x[k, lane]


@kernel
def _take(rows, first, lanes):
    """Eight rows from `first` on as lanes; the last row again where there are not as many."""
    for lane in range(LANES):
        row = min(first + lane, rows.shape[0] - 1)
        for k in range(rows.shape[1]):
            lanes[k, lane] = rows[row, k]
