"""The complete plant as one ordinary differential equation, and its fixed-step integrator.

State x (13 + 2n + m,): position (3,) and quaternion (4,) in the world, velocity nu_r (6,) relative
to the uniform flow V in the body frame, q (n,), q_dot (n,), thrust (m,): dynamics in nu_r and
p_dot = R v_r + V. With a constant V the frame that moves with it is inertial; where V varies with
time, weight and buoyancy act in it with g - V_dot (`water.stream`). What waves add is in the forces
on each body (`kernels.waves`). The wrench on the base is that of the thrusters, of the tether and
of whoever pushes from outside.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels.forward import accelerate
from uvms_dynamics.kernels.jit import inner, kernel
from uvms_dynamics.kernels.joints import passive_torque
from uvms_dynamics.kernels.layout import FIRST, HULL, RATE, TORQUE
from uvms_dynamics.kernels.layout import JOINTS as N_JOINTS
from uvms_dynamics.kernels.motion import (
    down_in_body,
    make_workspace,
    set_angle,
)
from uvms_dynamics.kernels.numba_internals.primitives import sqrt
from uvms_dynamics.kernels.spatial import load6, plus, spatial_at, store_spatial
from uvms_dynamics.model.vehicle_table import Model, build_model
from uvms_dynamics.simulation.tether import load_wrench, tether_load
from uvms_dynamics.simulation.thrusters import Thrusters, build_thrusters, thrust_rate
from uvms_dynamics.simulation.water import CurrentConfig, Water, build_water
from uvms_dynamics.simulation.water.stream import apparent_down, carried, stream_of
from uvms_dynamics.simulation.water.waves import spread_waves, take_bodies

POSITION, QUATERNION, VELOCITY, JOINTS = np.array([0, 3, 7, 13])
"""Where each part of the state begins; q_dot at JOINTS + n, thrust at JOINTS + 2n."""
DEPTH = POSITION + 2


NO_PUSH = np.zeros(0)
PUSH = 12
"""Length of a push: force (3,) N and moment (3,) N m in world axes, then the same in body axes."""


class System(NamedTuple):
    """What the derivative of the state depends on besides state and commands."""

    model: Model
    thrusters: Thrusters
    current: Array  # (3,) velocity of the water in the world, its constant part
    water: Water | None = None  # what moves beside it
    push: Array = NO_PUSH  # (0,) or (12,) wrench at the body origin: in world axes, in body axes


class Scratch(NamedTuple):
    """Tables that the integrator needs, allocated once."""

    work: Array  # of the kernels
    stage: Array  # (4, nx) derivatives of the Runge-Kutta stages
    trial: Array  # (nx,)
    wet: Array | None = None  # of `kernels.waves`, where there are waves


def make_scratch(system: System) -> Scratch:
    """Scratch tables for a system."""
    size, water = state_size(system), system.water
    wet = None if water is None or water.bodies is None else water.bodies.copy()
    return Scratch(make_workspace(system.model), np.empty((4, size)), np.empty(size), wet)


def state_size(system: System) -> int:
    """Length of the state: 13 + 2n + m."""
    return int(JOINTS + 2 * system.model[HULL, N_JOINTS]) + len(system.thrusters)


def make_system(
    vehicle: Vehicle, current: Sequence[float] | CurrentConfig = (0.0, 0.0, 0.0)
) -> System:
    """The system of a vehicle in a constant current (3,), m/s in the world, or in moving water."""
    constant, water = current, None
    if isinstance(current, CurrentConfig):
        constant, water = current.constant_ned_m_s, build_water(vehicle, current)
    return System(
        build_model(vehicle), build_thrusters(vehicle), np.array(constant, dtype=float), water
    )


def with_vehicle(system: System, vehicle: Vehicle) -> System:
    """The system with the bodies of another vehicle with as many joints, in the same flow.

    The thrusters stay as they are. A scratch of the system serves for this one, too.
    """
    water = None if system.water is None else system.water.around(vehicle)
    return system._replace(model=build_model(vehicle), water=water)


def make_state(
    q: Sequence[float],
    m: int,
    *,
    position: Sequence[float] = (0.0, 0.0, 0.0),
    quat: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
    nu_r: Sequence[float] = (0.0,) * 6,
    q_dot: Sequence[float] | None = None,
) -> Array:
    """State (13 + 2n + m,) with joint angles q (n,), rad, and m thrusters that are off.

    position (3,) m and unit quaternion (x, y, z, w) in the world, nu_r (6,) relative to the water,
    body frame, q_dot (n,) rad/s; level and at rest by default.
    """
    rates = np.zeros(len(q)) if q_dot is None else q_dot
    return np.concatenate([position, quat, nu_r, q, rates, np.zeros(m)])


@kernel
def advance(system, x, thrust_command, effort, step, scratch, states, rates, time):
    """Integrate by classical Runge-Kutta steps of `step` s under constant commands.

    x (nx,) is the state at `time`, s, and becomes the state at the end. Row k of states
    (steps+1, nx) is the state after k steps and row k of rates its derivative under these commands:
    thrust (m,) N, joint torque (n,) N m. `system` and `scratch` are the fields of a `System` and
    of a `Scratch`: plain tuples, which numba takes apart in a fraction of the time.
    `simulate` is built on it. Raises ValueError for arrays that do not fit.
    """
    model, thrusters, current, water, push = system
    n, m, last = effort.shape[0], thrust_command.shape[0], states.shape[0] - 1
    work, stage, trial, wet = scratch
    size = JOINTS + 2 * n + m
    if n != np.int64(model[HULL, N_JOINTS]) or m != thrusters.shape[0] or current.shape[0] != 3:
        raise ValueError("effort needs a value a joint, thrust_command a thruster, current three")
    if not (x.shape[0] == trial.shape[0] == states.shape[1] == rates.shape[1] == size):
        raise ValueError("x, scratch and the rows of states and rates need 13 + 2n + m values")
    if rates.shape[0] != states.shape[0] or not step >= 0.0:
        raise ValueError("states and rates need as many rows, and step must be >= 0")
    take_bodies(water, wet)
    for s in range(last + 1):
        now = time + s * step
        derivative(
            model, thrusters, current, water, push, now, n, m,
            x, thrust_command, effort, work, wet, stage, FIRST,
        )  # fmt: skip
        _record(x, stage, states, rates, s)
        if s < last:
            finish_step(
                model, thrusters, current, water, push, now, n, m,
                x, thrust_command, effort, step, work, wet, stage, trial,
            )  # fmt: skip


@inner
def _record(x, stage, states, rates, s):
    """Rows s: the state and its derivative (slices would compile numba's text formatting)."""
    for i in range(x.shape[0]):
        states[s, i] = x[i]
        rates[s, i] = stage[0, i]


@inner
def finish_step(
    model, thrusters, current, water, push, time, n, m,
    x, thrust_command, effort, step, work, wet, stage, trial,
):  # fmt: skip
    """Advance x by one step; row 0 of stage holds its derivative."""
    size = JOINTS + 2 * n + m
    for k in range(1, 4):
        part = step if k == 3 else 0.5 * step
        for i in range(size):
            trial[i] = x[i] + part * stage[k - 1, i]
        derivative(
            model, thrusters, current, water, push, time + part, n, m,
            trial, thrust_command, effort, work, wet, stage, k,
        )  # fmt: skip
    for i in range(size):
        x[i] += step / 6.0 * (stage[0, i] + 2.0 * (stage[1, i] + stage[2, i]) + stage[3, i])
    a, b, c, d = _unit_quaternion(x)
    x[QUATERNION], x[QUATERNION + 1], x[QUATERNION + 2], x[QUATERNION + 3] = a, b, c, d


@inner
def derivative(
    model, thrusters, current, water, push, time, n, m,
    x, thrust_command, effort, work, wet, out, k,
):  # fmt: skip
    """Row k of out: the derivative of the state x at a time, s, under these commands."""
    a, b, c, d = _unit_quaternion(x)
    nu_r = spatial_at(x, VELOCITY)
    rates = pose_rates(nu_r, a, b, c, d)
    moving = stream_of(water, time)
    drift = carried(current, moving)
    for i in range(3):  # over ground: the water carries it along
        out[k, POSITION + i] = rates[i] + drift[i]
    for i in range(3, 7):
        out[k, POSITION + i] = rates[i]
    for i in range(1, n + 1):
        angle, rate = x[JOINTS + i - 1], x[JOINTS + n + i - 1]
        set_angle(model, work, i, angle)
        work[i, RATE] = rate
        work[i, TORQUE] = effort[i - 1] + passive_torque(model, i, angle, rate)
        out[k, JOINTS + i - 1] = rate
    down = down_in_body(a, b, c, d)
    wrench = _thruster_wrench(thrusters, x, JOINTS + 2 * n)
    wrench = plus(wrench, load_wrench(tether_load(model, n, x[DEPTH]), down))
    if push.shape[0] == PUSH:
        wrench = plus(wrench, _push_in_body(push, a, b, c, d))
    quat = a, b, c, d
    spread_waves(model, water, wet, work, n, spatial_at(x, POSITION)[:3], quat, drift, time)
    down = apparent_down(water, moving, quat, down)
    nu_r_dot = accelerate(model, work, wet, n, down, nu_r, wrench)
    store_spatial(out, k, VELOCITY, nu_r_dot)
    for i in range(1, n + 1):
        out[k, JOINTS + n + i - 1] = work[i, RATE]
    for i in range(m):
        thrust = x[JOINTS + 2 * n + i]
        out[k, JOINTS + 2 * n + i] = thrust_rate(thrusters, i, thrust, thrust_command[i])


@inner
def _unit_quaternion(x):
    """Unit quaternion of the state; Runge-Kutta stages leave the unit sphere a little."""
    a, b, c, d = x[QUATERNION], x[QUATERNION + 1], x[QUATERNION + 2], x[QUATERNION + 3]
    scale = 1.0 / sqrt(a * a + b * b + c * c + d * d)
    return scale * a, scale * b, scale * c, scale * d


@inner
def _push_in_body(push, a, b, c, d):
    """Body wrench of a push; quat = (a, b, c, d)."""
    f = _into_body(push[0], push[1], push[2], a, b, c, d)
    t = _into_body(push[3], push[4], push[5], a, b, c, d)
    return (
        f[0] + push[6],
        f[1] + push[7],
        f[2] + push[8],
        t[0] + push[9],
        t[1] + push[10],
        t[2] + push[11],
    )


@inner
def _into_body(u, v, w, a, b, c, d):
    """R^T (u, v, w) = v - 2 e x (d v - e x v), e = (a, b, c)."""
    t0, t1, t2 = d * u - (b * w - c * v), d * v - (c * u - a * w), d * w - (a * v - b * u)
    return u - 2.0 * (b * t2 - c * t1), v - 2.0 * (c * t0 - a * t2), w - 2.0 * (a * t1 - b * t0)


@inner
def pose_rates(nu, a, b, c, d):
    """R v and the quaternion's rate 1/2 quat (omega, 0), seven numbers; quat = (a, b, c, d)."""
    u, v, w, p, q, r = nu
    # R v = v + 2 e x (e x v + d v), with e the vector part
    t0, t1, t2 = b * w - c * v + d * u, c * u - a * w + d * v, a * v - b * u + d * w
    return (
        u + 2.0 * (b * t2 - c * t1),
        v + 2.0 * (c * t0 - a * t2),
        w + 2.0 * (a * t1 - b * t0),
        0.5 * (d * p + b * r - c * q),
        0.5 * (d * q + c * p - a * r),
        0.5 * (d * r + a * q - b * p),
        -0.5 * (a * p + b * q + c * r),
    )


@inner
def _thruster_wrench(thrusters, x, first):
    """Body wrench of the thrusters; their thrusts are in x from `first` on."""
    wrench = _scaled_row(thrusters, FIRST, x[first])
    for i in range(1, thrusters.shape[0]):
        wrench = plus(wrench, _scaled_row(thrusters, i, x[first + i]))
    return wrench


@inner
def _scaled_row(thrusters, i, thrust):
    """Wrench of thruster i."""
    k = load6(thrusters, i, FIRST)
    return k[0] * thrust, k[1] * thrust, k[2] * thrust, k[3] * thrust, k[4] * thrust, k[5] * thrust
