"""Limits of a vehicle's joints as arrays in SI units."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle.vehicle import Vehicle


def joint_limits(vehicle: Vehicle) -> tuple[Array, Array]:
    """Lower and upper limits (n,) of the joint angles, rad."""
    joints = vehicle.arm.joints
    lower = np.radians([joint.lower_deg for joint in joints])
    return lower, np.radians([joint.upper_deg for joint in joints])
