"""How fast the plan may move the vehicle: by rule, from its thrusters, drag and inertia."""

from typing import NamedTuple

import numpy as np

from uvms_core.signals import Array
from uvms_core.vehicle import Vehicle
from uvms_core.vehicle.frames import arm_length
from uvms_dynamics import Model, inverse_dynamics, mass_matrix, restoring_wrench
from uvms_dynamics.external_bandwidth import thrust_authority
from uvms_planner.config import FASTEST_M_S, FASTEST_TURN_DEG_S
from uvms_planner.errors import PlannerError

SPEED_SHARE = 0.5
"""Of the thrust along an axis, that steady motion along it may take against drag, and of each
joint's torque, that holding the stowed arm against the flow may take."""
ACCELERATION_SHARE = 0.25
"""Of the thrust, that the plan's acceleration may take. The quarter that is left is for the
controller, for currents and for the arm's reaction."""
FASTEST_TURN = np.deg2rad(FASTEST_TURN_DEG_S)
HALVINGS = 40
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
AXES = (0, 1, 2, 5)
"""Surge, sway, heave and yaw of the body axes."""


class VehicleLimits(NamedTuple):
    """Greatest rates and accelerations of x, y, z and psi, along the axes of map_ned."""

    rate: Array  # (4,) m/s, rad/s
    acceleration: Array  # (4,) m/s^2, rad/s^2


def vehicle_limits(vehicle: Vehicle, model: Model) -> VehicleLimits:
    """The limits that the vehicle's own thrust gives, the arm stowed.

    Along an axis, `SPEED_SHARE` of the thrust that weight and buoyancy leave holds the speed
    against the drag of hull, fins and arm, and `ACCELERATION_SHARE` moves mass and added mass. In
    the plane the weaker of surge and sway counts, because the heading is free. An axis without
    thrust, which no limit would help, has those of the slower of the others. In yaw, the tool at
    the arm's full length moves no faster than the vehicle does.

    Raises:
        PlannerError: no thruster pushes along any axis.
    """
    q = np.radians(vehicle.arm.stowed_deg)
    still = np.abs(restoring_wrench(model, LEVEL, q))
    thrust = np.maximum(thrust_authority(vehicle) - still, 0.0)
    inertia = np.diag(mass_matrix(model, q))
    acceleration = ACCELERATION_SHARE * thrust / inertia[:6]
    rate = np.zeros(6)
    for axis in AXES:
        if thrust[axis] > 0.0:
            rate[axis] = _steady_speed(vehicle, model, q, axis, thrust[axis])
    lever = float(np.hypot(*vehicle.arm.base.position_m[:2])) + arm_length(vehicle.arm)
    return VehicleLimits(_by_axis(rate, lever), _by_axis(acceleration, lever))


def _by_axis(values: Array, lever: float) -> Array:
    """Of x, y, z and psi (4,), from those of the body axes (6,), where 0 means no thrust."""
    pushed = values[:3][values[:3] > 0.0]
    if not len(pushed):
        raise PlannerError(
            "planner.limits: no thruster pushes along x, y or z, so that no limits follow from the"
            " vehicle file; give translation_rate_m_s and translation_acceleration_m_s2,"
            " yaw_rate_deg_s and yaw_acceleration_deg_s2"
        )
    surge, sway, heave = np.where(values[:3] > 0.0, values[:3], pushed.min())
    plane = min(surge, sway, FASTEST_M_S)
    turn = min(values[5] if values[5] > 0.0 else np.inf, plane / lever, FASTEST_TURN)
    return np.array([plane, plane, min(heave, FASTEST_M_S), turn])


def _steady_speed(vehicle: Vehicle, model: Model, q: Array, axis: int, thrust: float) -> float:
    """Speed along or about an axis that takes `SPEED_SHARE` of thrust or of a joint's torque."""
    efforts = np.array([joint.effort_limit_nm for joint in vehicle.arm.joints])
    zero = np.zeros(6)
    static = inverse_dynamics(model, LEVEL, zero, zero, q, 0 * q, 0 * q)

    def share(speed: float) -> float:
        """The greater share of both directions."""
        greatest = 0.0
        for sign in (1.0, -1.0):
            nu = zero.copy()
            nu[axis] = sign * speed
            load = inverse_dynamics(model, LEVEL, nu, zero, q, 0 * q, 0 * q) - static
            joints = np.max(np.abs(load[6:]) / efforts, initial=0.0)
            greatest = max(greatest, abs(load[axis]) / thrust, float(joints))
        return greatest

    slow, fast = 0.0, max(FASTEST_M_S, FASTEST_TURN)
    if share(fast) <= SPEED_SHARE:
        return fast
    for _ in range(HALVINGS):
        middle = 0.5 * (slow + fast)
        slow, fast = (middle, fast) if share(middle) <= SPEED_SHARE else (slow, middle)
    return slow
