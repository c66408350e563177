"""The fitness of a candidate, eq. (18): the smaller the self-disturbance, the fitter."""

import numpy as np

from uvms_dynamics import coupling_wrench, restoring_wrench
from uvms_dynamics.kernels.jit import inner, kernel, shared
from uvms_planner.constraints import attitude_violation
from uvms_planner.problem import VEHICLE, configuration_after, yaw_quaternion
from uvms_planner.projection import project, within_tolerance


@inner
def body_motion(configuration, previous, increment, h):
    """Nu (6,) and nu_dot (6,), body frame, of the level vehicle under an increment in h s.

    Rates are the increment over the step, accelerations its change from the step before:
    nu = R^T p_dot, nu_dot = R^T p_ddot - omega x nu.
    """
    yaw = configuration[3] + increment[3]
    c, s = np.cos(yaw), np.sin(yaw)
    nu, nu_dot = np.zeros(6), np.zeros(6)
    x, y = increment[0] / h, increment[1] / h
    nu[0], nu[1], nu[2] = c * x + s * y, -s * x + c * y, increment[2] / h
    nu[5] = increment[3] / h
    x = (increment[0] - previous[0]) / h**2
    y = (increment[1] - previous[1]) / h**2
    nu_dot[0] = c * x + s * y + nu[5] * nu[1]
    nu_dot[1] = -s * x + c * y - nu[5] * nu[0]
    nu_dot[2] = (increment[2] - previous[2]) / h**2
    nu_dot[5] = (increment[3] - previous[3]) / h**2
    return nu, nu_dot


@kernel
def self_disturbance(model, problem, increment, lookahead):
    """Restoring (first six) and coupling wrench (last six) of a candidate, body frame; (12,).

    Their sum is F_dis of eq. (16). The restoring wrench is taken where the joints would be
    `lookahead` s after the step if they kept their rate; the coupling wrench at the step, in still
    water.
    """
    return _wrenches(
        model, problem.configuration, problem.previous, increment, problem.step, lookahead
    )


@shared
def _wrenches(model, configuration, previous, increment, h, lookahead):
    nu, nu_dot = body_motion(configuration, previous, increment, h)
    q, ahead = np.empty(increment.shape[0] - VEHICLE), np.empty(increment.shape[0] - VEHICLE)
    q_dot, q_ddot = np.empty_like(q), np.empty_like(q)
    for i in range(q.shape[0]):
        j = VEHICLE + i
        q[i] = configuration[j] + increment[j]
        q_dot[i] = increment[j] / h
        q_ddot[i] = (increment[j] - previous[j]) / h**2
        ahead[i] = q[i] + lookahead * q_dot[i]
    level = yaw_quaternion(configuration[3] + increment[3])
    restoring = restoring_wrench(model, level, ahead)
    coupling = coupling_wrench(model, nu, nu_dot, q, q_dot, q_ddot)
    wrenches = np.zeros(12)
    for i in range(6):
        wrenches[i], wrenches[6 + i] = restoring[i], coupling[i]
    return wrenches


@inner
def judged_disturbance(model, configuration, previous, increment, h, lookahead, combined):
    """Residuals (12,) of a candidate's self-disturbance; their squares add up to its cost.

    F_dis and zeros, as eq. (18) is printed, where `combined`; else restoring and
    coupling wrench on their own: in the sum a jerk of the arm would pay for a weight that stays.
    """
    wrenches = _wrenches(model, configuration, previous, increment, h, lookahead)
    if combined:
        for i in range(6):
            wrenches[i] += wrenches[6 + i]
            wrenches[6 + i] = 0.0
    return wrenches


@inner
def cost(model, problem, increment):
    """Sum of the squared self-disturbance, eq. (18), and what motion and change of rate cost."""
    total, previous = 0.0, problem.previous
    for value in judged_disturbance(
        model,
        problem.configuration,
        previous,
        increment,
        problem.step,
        problem.lookahead,
        problem.combined,
    ):
        total += value**2
    reach, jump = problem.reach, problem.jump
    motion_weights, smoothness_weight = problem.motion_weights, problem.smoothness_weight
    for i in range(increment.shape[0]):
        if reach[i] > 0.0:
            change = (increment[i] - previous[i]) / jump[i]
            total += smoothness_weight * change**2
            total += motion_weights[i] * (increment[i] / reach[i]) ** 2
    return total


@kernel
def judge(model, problem, increment):
    """Project `increment` (m,) in place; return (valid, attitude violation in rad, cost).

    A candidate with an end-effector error of e or more is not valid and is discarded, eq. (17).
    """
    distance, angle = project(model, problem, increment)
    if not within_tolerance(problem, distance, angle):
        return False, np.inf, np.inf
    q = configuration_after(problem.configuration, increment)[VEHICLE:]
    violation = attitude_violation(model, problem, q)
    return True, violation, cost(model, problem, increment)
