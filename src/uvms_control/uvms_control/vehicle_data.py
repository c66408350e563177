"""What the controller and the allocator read from the vehicle, as arrays in SI units."""

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix


def effort_limits(vehicle: Vehicle) -> Array:
    """Largest joint torques (n,) in N m."""
    return np.array([joint.effort_limit_nm for joint in vehicle.arm.joints])


def thruster_limits(vehicle: Vehicle) -> tuple[Array, Array]:
    """Greatest thrusts (2, m), astern and ahead, in N and largest rate of thrust (m,) in N/s."""
    parts = vehicle.thrusters
    limits = np.array([[part.astern_n for part in parts], [part.ahead_n for part in parts]])
    return limits, np.array([part.slew_limit_n_s for part in parts])


def least_thrusts(vehicle: Vehicle) -> Array:
    """Smallest thrusts but none (2, m), astern and ahead, in N; 0 where there is no gap."""
    return np.array([part.least_n for part in vehicle.thrusters]).T


def thruster_lags(vehicle: Vehicle) -> Array:
    """Time constants of the thrusters' first-order lag (m,) in s."""
    return np.array([part.time_constant_s for part in vehicle.thrusters])


def least_moment(vehicle: Vehicle) -> float:
    """Smallest moment that the thrusters have about an axis, N m; axes without any are left out.

    Each thruster by the lesser of its limits, all at once about one axis. An axis counts as without
    moment below a thousandth of the greatest; infinite where there is no moment at all.
    """
    limits, _ = thruster_limits(vehicle)
    moments = np.abs(thruster_matrix(vehicle)[3:]) @ np.abs(limits).min(axis=0)
    there = moments[moments > 1e-3 * moments.max()]
    return float(there.min()) if there.size else float("inf")
