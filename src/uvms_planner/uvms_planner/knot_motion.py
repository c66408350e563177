"""Rate and acceleration at a knot, so that segments join smoothly and stay on the path."""

import numpy as np

from uvms_dynamics.kernels.jit import kernel, shared
from uvms_planner.linear import copy_into
from uvms_planner.problem import configuration_after
from uvms_planner.projection import configuration_jacobian, weighted_step

DIFFERENCE_S = 1e-3


@kernel
def knot_motion(model, problem, increment, tool_rate, tool_acceleration):
    """Rate (m,) and acceleration (m,) of c at the end of a step.

    Backward differences of the increments d, exact for constant acceleration,
        c_dot = (3 d - d_before) / 2 h,  c_ddot = (d - d_before) / h^2,
    then moved the least way, weighted, to where the tool has the path's own velocity and
    acceleration (6,): J c_dot = y_dot and J c_ddot + J_dot c_dot = y_ddot.
    """
    h = problem.step
    end = configuration_after(problem.configuration, increment)
    rate, acceleration = np.empty_like(end), np.empty_like(end)
    for i in range(end.shape[0]):
        rate[i] = (3 * increment[i] - problem.previous[i]) / (2 * h)
        acceleration[i] = (increment[i] - problem.previous[i]) / h**2
    meet(model, problem, end, tool_rate, tool_acceleration, rate, acceleration)
    return rate, acceleration


@kernel
def meet(model, problem, end, tool_rate, tool_acceleration, rate, acceleration):
    """Change `rate` and `acceleration` (m,) of c at `end` (m,) in place the least way so that
    J c_dot = y_dot and J c_ddot + J_dot c_dot = y_ddot for the tool's `tool_rate` and
    `tool_acceleration` (6,).
    """
    jacobian = configuration_jacobian(model, end)
    _meet(problem, jacobian, tool_rate, rate)
    ahead, behind = np.empty_like(end), np.empty_like(end)
    for i in range(end.shape[0]):
        ahead[i], behind[i] = end[i] + DIFFERENCE_S * rate[i], end[i] - DIFFERENCE_S * rate[i]
    slope = configuration_jacobian(model, ahead)
    before = configuration_jacobian(model, behind)
    for a in range(slope.shape[0]):
        for i in range(slope.shape[1]):
            slope[a, i] = (slope[a, i] - before[a, i]) / (2 * DIFFERENCE_S)
    target = np.empty(6)
    copy_into(target, tool_acceleration)
    _subtract_product(slope, rate, target)
    _meet(problem, jacobian, target, acceleration)


@shared
def _meet(problem, jacobian, target, vector):
    """Change `vector` (m,) in place the least way so that J vector = target."""
    equations = 6 if problem.oriented else 3
    free, step = np.empty(vector.shape[0], dtype=np.bool_), np.empty(vector.shape[0])
    for i in range(vector.shape[0]):
        free[i] = problem.readiness[i] > 0.0
    error = np.empty(6)
    for _ in range(2):  # the second takes away what the damping leaves
        copy_into(error, target)
        _subtract_product(jacobian, vector, error)
        weighted_step(jacobian, error, problem.readiness, free, problem.damping, equations, step)
        for i in range(vector.shape[0]):
            vector[i] += step[i]


@shared
def _subtract_product(matrix, vector, out):
    """Out - matrix vector, in place."""
    for a in range(matrix.shape[0]):
        for i in range(matrix.shape[1]):
            out[a] -= matrix[a, i] * vector[i]
