"""Where thrusters push: thrusts to a wrench on the vehicle."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle


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
