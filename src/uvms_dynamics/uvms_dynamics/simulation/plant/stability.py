"""The largest stable Runge-Kutta step of the plant, linearized about the states it can reach.

A step h follows a mode of eigenvalue lambda by the factor R(h lambda), the equation itself by
exp(h lambda). A step is refused where some mode that decays, or only swings, grows under it
(Hairer and Wanner, Solving Ordinary Differential Equations II, 1996, sec. IV.2).
"""

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from uvms_core.errors import ConfigError
from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics.kernels import joint_passive_torque, mass_matrix
from uvms_dynamics.model.vehicle_table import build_model
from uvms_dynamics.simulation.events import Event, Load, loaded
from uvms_dynamics.simulation.events.payload import PayloadEvent
from uvms_dynamics.simulation.integrator import (
    JOINTS,
    QUATERNION,
    VELOCITY,
    System,
    advance,
    make_scratch,
    make_system,
)
from uvms_dynamics.simulation.plant.config import PlantConfig
from uvms_dynamics.simulation.plant.operating_points import AXES, Point, operating_points
from uvms_dynamics.simulation.plant.stiffest_poses import stop_depths

Complex = NDArray[np.complex128]

_LONGEST = 4.0
"""Largest |h lambda| searched: the stability region of the method ends before."""

_SLOW = 0.2
"""Modes slower than this fraction of the fastest do not bound the step: the radius of the region is
between 1 and 4 in every direction, so the fastest does."""

_ROUNDING, _FOLLOWED = 1e-9, 1e-2
"""How much a mode may grow in a step: only by rounding where it decays, and by a hundredth more
than the exact solution where it grows."""


_BOUNCE = 2.2
"""Largest |h lambda| of an elastic stop. The kink where it begins is anywhere in a step, which adds
energy to some bounces and takes it from others: up to 2.3 they lose energy on average."""


class Bound(NamedTuple):
    """The greatest stable step and the mode that sets it."""

    step_s: float
    eigenvalue: complex  # 1/s
    point: Point
    slope: Array  # of the state's rate there, see `jacobian`


def check_step(vehicle: Vehicle, config: PlantConfig) -> None:
    """Raise ConfigError where the step is unstable; names step, mode, and the greatest step."""
    try:
        bound = greatest_step(vehicle, config)
    except np.linalg.LinAlgError as fault:  # masses, lengths or frictions of 1e100 and more
        raise ConfigError(
            f"step_s: no step can be found for vehicle {vehicle.name}: its equations have no"
            f" solution in 64-bit numbers ({fault}); a mass, length, friction or stop is too great"
            " or too small against the others"
        ) from fault
    if config.step_s > bound.step_s:
        raise ConfigError(
            f"step_s: {config.step_s:g} s is unstable with the {cause_of(vehicle, bound)}: a mode"
            f" of {abs(bound.eigenvalue):.3g} 1/s, {bound.point.name};"
            f" allowed: at most {_rounded_down(bound.step_s):g} s"
        )


def check_plant(vehicle: Vehicle, config: PlantConfig, events: Iterable[Event]) -> None:
    """As `check_step`, also with each payload of the events; ConfigError names the payload."""
    check_step(vehicle, config)
    for event in events:
        if isinstance(event, PayloadEvent) and isinstance(event.payload, Load):
            try:
                check_step(loaded(vehicle, event.payload), config)
            except ConfigError as fault:
                raise ConfigError(f"{fault} (with the {event.text()})") from fault


def greatest_step(vehicle: Vehicle, config: PlantConfig) -> Bound:
    """The greatest stable step over all operating points; `config` gives start and current."""
    system = make_system(vehicle, config.flow.constant_ned_m_s)
    points = list(operating_points(vehicle, system.model, config))
    slopes = np.array([jacobian(vehicle, system, point) for point in points])
    # A state without finite rates does not depend on the step: the plant reports it.
    slopes[~np.isfinite(slopes).all(axis=(1, 2))] = 0.0
    eigenvalues = np.linalg.eigvals(slopes).astype(complex)
    eigenvalues[np.abs(eigenvalues) < _SLOW * np.abs(eigenvalues).max()] = 0.0
    steps = stable_steps(eigenvalues)
    strikes = np.array([[point.strikes] for point in points])
    with np.errstate(divide="ignore"):
        steps = np.minimum(steps, np.where(strikes, _BOUNCE / np.abs(eigenvalues.imag), math.inf))
    at, k = np.unravel_index(int(np.argmin(steps)), steps.shape)
    return Bound(float(steps[at, k]), complex(eigenvalues[at, k]), points[at], slopes[at])


def jacobian(vehicle: Vehicle, system: System, point: Point) -> Array:
    """Slope (nx-3, nx-3) of the state's rate, without the position.

    Only a tether depends on it, and its bounds keep that mode slow.
    """
    n = vehicle.n_joints
    fields, tables = tuple(system), tuple(make_scratch(system))
    thrust = point.state[JOINTS + 2 * n :].copy()
    row, rate = np.empty((1, len(point.state))), np.empty((1, len(point.state)))

    def rates(x: Array) -> Array:
        advance(fields, x, thrust, point.effort, 0.0, tables, row, rate, 0.0)
        return rate[0, QUATERNION:].copy()

    columns = []
    for shift in np.diag(_differences(vehicle, point))[QUATERNION:]:
        change = rates(point.state + shift) - rates(point.state - shift)
        columns.append(change / (2.0 * shift.max()))
    return np.array(columns).T


def _differences(vehicle: Vehicle, point: Point) -> Array:
    """Half widths (nx,) of the central differences, small against friction, stops and slew."""
    n, joints, thrusters = vehicle.n_joints, vehicle.arm.joints, vehicle.thrusters
    result = 1e-6 * np.maximum(1.0, np.abs(point.state))
    width = np.radians([joint.coulomb_width_deg_s for joint in joints])
    depth = np.array([depth or math.inf for depth in stop_depths(vehicle)])
    slew = [part.time_constant_s * part.slew_limit_n_s for part in thrusters]
    for first, narrowest in ((JOINTS, depth), (JOINTS + n, width), (JOINTS + 2 * n, slew)):
        part = slice(first, first + len(narrowest))
        result[part] = np.minimum(result[part], 1e-3 * np.array(narrowest))
    return result


def stable_steps(eigenvalues: Complex) -> Array:
    """Greatest step for each eigenvalue, 1/s; infinite where any step is stable."""
    size = np.abs(eigenvalues)
    result = np.full(size.shape, math.inf)
    result[size > 0.0] = _radii(eigenvalues[size > 0.0] / size[size > 0.0]) / size[size > 0.0]
    return result


def _radii(direction: Complex) -> Array:
    """Largest |z| along each direction (k,), unit complex numbers, with all below it stable."""
    radii = np.linspace(0.0, _LONGEST, 101)
    bad = _gains_too_much(radii[:, None] * direction)
    first = np.argmax(bad, axis=0)  # 0 where none is bad
    inside, outside = radii[np.maximum(first - 1, 0)], radii[first]
    for _ in range(40):
        middle = 0.5 * (inside + outside)
        beyond = _gains_too_much(middle * direction)
        inside, outside = np.where(beyond, inside, middle), np.where(beyond, middle, outside)
    return np.where(first > 0, inside, math.inf)


def amplification(z: Complex) -> Complex:
    """R(z) = 1 + z + z^2/2 + z^3/6 + z^4/24: the factor of one Runge-Kutta step, for exp(z)."""
    return 1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0)))


def _gains_too_much(z: Complex) -> NDArray[np.bool_]:
    growth = np.where(z.real > 0.0, np.exp(z.real) * (1.0 + _FOLLOWED), 1.0 + _ROUNDING)
    return np.abs(amplification(z)) > growth


def cause_of(vehicle: Vehicle, bound: Bound) -> str:
    """The cause of the mode: the part with the largest share in it, and why it is fast.

    Shares are participation factors |left x right eigenvector|, the singular vectors that
    belong to the least singular value of A - lambda.
    """
    point, n = bound.point, vehicle.n_joints
    left, _, right = np.linalg.svd(bound.slope - bound.eigenvalue * np.eye(len(bound.slope)))
    share = np.zeros(len(point.state))
    share[QUATERNION:] = np.abs(left[:, -1] * right[-1])
    hull, thrust = share[VELOCITY:JOINTS], share[JOINTS + 2 * n :]
    joints = share[JOINTS : JOINTS + n] + share[JOINTS + n : JOINTS + 2 * n]
    k = int(np.argmax([*hull, *joints, *thrust]))
    if k < len(AXES):
        return f"damping of the hull in {AXES[k]}"
    k -= len(AXES)
    if k < n:
        return _cause_in_joint(vehicle, point, k, abs(bound.eigenvalue))
    return f"time_constant_s of thrusters.{k - n} ({vehicle.thrusters[k - n].name})"


def _cause_in_joint(vehicle: Vehicle, point: Point, i: int, rate: float) -> str:
    """Friction, stop or water: the greatest share in s^2 I + s (b + b_stop) + k = 0, |s| = rate."""
    n = vehicle.n_joints
    q, q_dot = point.state[JOINTS : JOINTS + n], point.state[JOINTS + n : JOINTS + 2 * n]
    h = _differences(vehicle, point)[JOINTS + i], _differences(vehicle, point)[JOINTS + n + i]
    unit, model = np.eye(n)[i], build_model(vehicle)

    def slope(angle: Array, shift_q: Array, shift_rate: Array, width: float) -> float:
        ends = [
            joint_passive_torque(model, angle + sign * shift_q, q_dot + sign * shift_rate)[i]
            for sign in (1.0, -1.0)
        ]
        return float(ends[1] - ends[0]) / (2.0 * width)

    joint, still = vehicle.arm.joints[i], np.zeros(n)
    free = np.where(unit > 0.0, np.radians(0.5 * (joint.lower_deg + joint.upper_deg)), q)
    friction = rate * slope(free, still, h[1] * unit, h[1])
    stiffness = slope(q, h[0] * unit, still, h[0])
    dissipation = rate * slope(q, still, h[1] * unit, h[1]) - friction
    water = 0.25 * rate**2 / np.linalg.inv(mass_matrix(model, q))[6 + i, 6 + i]
    where = f"arm.joints.{i} ({joint.name})"
    shares = {
        f"friction of {where} (raise coulomb_width_deg_s)": friction,
        f"stop_stiffness_nm_rad of {where}": stiffness,
        f"stop_dissipation_s_rad of {where}": dissipation,
        f"drag of the links about {where}": water,
    }
    return max(shares, key=lambda part: shares[part])


def _rounded_down(step: float) -> float:
    """To three digits, so that the value in a message is one that is allowed."""
    scale = 10.0 ** (2 - math.floor(math.log10(step)))
    return math.floor(step * scale) / scale
