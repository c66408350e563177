"""Thrusters: what they do to the vehicle and how they follow a command."""

import numpy as np

from uvms_dynamics.kernels.arithmetic import bounded
from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.signals import Array
from uvms_dynamics.vehicle import Vehicle

Thrusters = Array
"""Table (m, 9) of m thrusters for the kernels, SI: wrench per newton (6), limit, 1 / time
constant, slew limit."""

LIMIT, PER_TIME_CONSTANT, SLEW = np.arange(6, 9)


def configuration_matrix(positions: Array, directions: Array) -> Array:
    """B (6, m): column i is the wrench [d_i; r_i x d_i] about the body origin of one newton.

    positions (m, 3) in m and directions (m, 3), unit vectors, in the body frame (Fossen, Handbook
    of Marine Craft Hydrodynamics and Motion Control, 2nd ed., eq. (12.230)).
    """
    return np.ascontiguousarray(np.hstack([directions, np.cross(positions, directions)]).T)


def thruster_matrix(vehicle: Vehicle) -> Array:
    """Configuration matrix B (6, m) of a vehicle's thrusters: wrench = B thrust."""
    return configuration_matrix(
        np.array([thruster.position_m for thruster in vehicle.thrusters]),
        np.array([thruster.direction for thruster in vehicle.thrusters]),
    )


def build_thrusters(vehicle: Vehicle) -> Thrusters:
    """Thruster tables of a vehicle."""
    parts = vehicle.thrusters
    drives = [[part.limit_n, 1.0 / part.time_constant_s, part.slew_limit_n_s] for part in parts]
    return np.hstack([thruster_matrix(vehicle).T, drives])


@inner
def thrust_rate(thrusters, i, thrust, command):
    """Rate of change of thrust i, N/s: (u - T) / tau within the slew limit, |u| <= limit."""
    limit, slew = thrusters[i, LIMIT], thrusters[i, SLEW]
    wanted = bounded(command, limit)
    return bounded((wanted - thrust) * thrusters[i, PER_TIME_CONSTANT], slew)
