"""What the controller and the allocator read from the vehicle, as arrays in SI units."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle


def effort_limits(vehicle: Vehicle) -> Array:
    """Largest joint torques (n,) in N m."""
    return np.array([joint.effort_limit_nm for joint in vehicle.arm.joints])


def thruster_limits(vehicle: Vehicle) -> tuple[Array, Array]:
    """Largest thrust (m,) in N and largest rate of thrust (m,) in N/s."""
    limits = np.array([thruster.limit_n for thruster in vehicle.thrusters])
    return limits, np.array([thruster.slew_limit_n_s for thruster in vehicle.thrusters])
