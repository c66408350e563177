"""Attitude limits of eq. (17) and Deb's rule for candidates that break them."""

import numpy as np

from uvms_dynamics import restoring_wrench
from uvms_dynamics.kernels.jit import inner


@inner
def free_attitude(model, q):
    """Roll and pitch in rad that the vehicle takes up freely with the joints at `q` (n,).

    P = sum m g r_g - sum rho V g r_b; roll = atan2(P_y, P_z), pitch = atan2(-P_x, hypot(P_y, P_z)).
    P is read from the restoring moment P x u of eq. (13), u the direction of gravity in the body
    frame: u = z when level gives P_x, P_y; u = y when rolled by 90 degrees gives P_z.
    """
    quaternion = np.zeros(4)
    quaternion[3] = 1.0
    level = restoring_wrench(model, quaternion, q)
    quaternion[0] = quaternion[3] = np.sqrt(0.5)
    rolled = restoring_wrench(model, quaternion, q)
    p_x, p_y, p_z = -level[4], level[3], -rolled[3]
    return np.arctan2(p_y, p_z), np.arctan2(-p_x, np.hypot(p_y, p_z))


@inner
def attitude_violation(model, problem, q):
    """How far in rad the free attitude lies beyond the limits, roll and pitch added; 0 within."""
    roll, pitch = free_attitude(model, q)
    return max(abs(roll) - problem.roll_max, 0.0) + max(abs(pitch) - problem.pitch_max, 0.0)


@inner
def better(violation, cost, other_violation, other_cost):
    """Deb's rule: less violation beats more, and of two without any the lower cost wins."""
    if violation != other_violation:
        return violation < other_violation
    return cost < other_cost
