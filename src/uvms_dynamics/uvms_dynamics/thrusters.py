"""Thrusters: what they do to the vehicle and how they follow a command."""

from typing import NamedTuple

import numpy as np

from uvms_dynamics.kernels.jit import inner
from uvms_dynamics.signals import Array
from uvms_dynamics.vehicle import Vehicle


class Thrusters(NamedTuple):
    """Tables of m thrusters for the kernels, SI."""

    matrix: Array  # (6, m) wrench per newton
    limit: Array  # (m,) greatest thrust, either way
    time_constant: Array  # (m,)
    slew_limit: Array  # (m,) N/s


def thruster_matrix(vehicle: Vehicle) -> Array:
    """Configuration matrix B (6, m): wrench about the body origin = B thrust; [d; r x d]."""
    directions = np.array([thruster.direction for thruster in vehicle.thrusters])
    positions = np.array([thruster.position_m for thruster in vehicle.thrusters])
    return np.hstack([directions, np.cross(positions, directions)]).T.copy()


def build_thrusters(vehicle: Vehicle) -> Thrusters:
    """Thruster tables of a vehicle."""
    parts = vehicle.thrusters
    return Thrusters(
        thruster_matrix(vehicle),
        np.array([part.limit_n for part in parts]),
        np.array([part.time_constant_s for part in parts]),
        np.array([part.slew_limit_n_s for part in parts]),
    )


@inner
def thrust_rate(limit, time_constant, slew, i, thrust, command):
    """Rate of change of thrust i, N/s: (u - T) / tau within the slew limit, |u| <= limit."""
    wanted = min(max(command, -limit[i]), limit[i])
    return min(max((wanted - thrust) / time_constant[i], -slew[i]), slew[i])
