"""Vehicles that are one simple body to the water, and how they move in it."""

from typing import Any

import numpy as np
from random_vehicles import REFERENCE

from uvms_core.vehicle import Vehicle, vehicle_from_data
from uvms_dynamics import quat_to_matrix
from uvms_dynamics.simulation import make_state, make_system, simulate
from uvms_dynamics.simulation.integrator import VELOCITY, advance, make_scratch
from uvms_dynamics.simulation.water import CurrentConfig
from uvms_dynamics.simulation.water.stream import stream_at

DENSITY = REFERENCE.environment.water_density_kg_m3
VOLUME = 0.1
DISPLACED = DENSITY * VOLUME
"""Of the ball, kg."""


def ball(mass: float = DISPLACED, damping: float = 0.0) -> Vehicle:
    """A sphere of 0.1 m^3, added mass rho V / 2, with linear damping; its arm is nothing."""
    data = without_arm(REFERENCE)
    inertia = 0.4 * mass * 0.08
    data["hull"].update(
        mass_kg=mass, volume_m3=VOLUME, cg_m=[0.0] * 3, cb_m=[0.0] * 3,
        inertia_kg_m2=(inertia * np.eye(3)).tolist(), spheroid=None,
        added_mass=np.diag([0.5 * DISPLACED] * 3 + [0.0] * 3).tolist(),
        linear_damping=[damping] * 6, quadratic_damping=[0.0] * 6, fins=[],
    )  # fmt: skip
    return vehicle_from_data(data)


def without_arm(vehicle: Vehicle) -> dict[str, Any]:
    """Data of a vehicle whose arm weighs, displaces and drags nothing to speak of."""
    data = vehicle.model_dump(mode="json")
    for link in data["arm"]["links"]:
        link.update(mass_kg=1e-9, volume_m3=1e-12, inertia_kg_m2=[1e-15] * 3, drag=[])
        link.update(added_mass=[0.0] * 6, cylinder=None, cg_m=[0.0] * 3, cb_m=[0.0] * 3)
    return data


def drift(
    vehicle: Vehicle, current: CurrentConfig, duration: float, step: float = 0.005, **start: Any
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (k,), and positions and velocities (k, 3) of a free body over ground in the world."""
    system, n = make_system(vehicle, current), vehicle.n_joints
    x = make_state([0.0] * n, vehicle.n_thrusters, **({"position": (0.0, 0.0, 10.0)} | start))
    idle = np.zeros(vehicle.n_thrusters), np.zeros(n)
    states = simulate(system, x, *idle, step, round(duration / step))
    times = step * np.arange(len(states))
    return times, states[:, :3], over_ground(system, states, times)


def over_ground(system, states, times):
    """Velocities (k, 3) of the body origin in the world."""
    stream = np.zeros((len(times), 3))
    if system.water is not None:
        stream = stream_at(system.water, times)[:, :3]
    turned = [quat_to_matrix(x[3:7]) @ x[VELOCITY : VELOCITY + 3] for x in states]
    return np.array(turned) + system.current + stream


def rates_at(system, x, effort, time):
    """Derivative (nx,) of a state at a time, without thrust."""
    row, rate = np.empty((1, len(x))), np.empty((1, len(x)))
    thrust = np.zeros(len(system.thrusters))
    advance(system, x.copy(), thrust, effort, 0.0, make_scratch(system), row, rate, time)
    return rate[0]
