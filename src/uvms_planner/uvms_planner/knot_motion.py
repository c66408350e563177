"""Rate and acceleration at a knot, so that segments join smoothly and stay on the path."""

import numpy as np

from uvms_dynamics.kernels.jit import kernel
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
    end = problem.configuration + increment
    rate = (3 * increment - problem.previous) / (2 * h)
    acceleration = (increment - problem.previous) / h**2
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
    after = configuration_jacobian(model, end + DIFFERENCE_S * rate)
    before = configuration_jacobian(model, end - DIFFERENCE_S * rate)
    wanted = tool_acceleration.copy()
    _subtract_product((after - before) / (2 * DIFFERENCE_S), rate, wanted)
    _meet(problem, jacobian, wanted, acceleration)


@kernel
def _meet(problem, jacobian, wanted, vector):
    """Change `vector` (m,) in place the least way so that J vector = wanted."""
    equations = 6 if problem.oriented else 3
    free = problem.readiness > 0.0
    step = np.zeros_like(vector)
    for _ in range(2):  # the second takes away what the damping leaves
        error = wanted.copy()
        _subtract_product(jacobian, vector, error)
        weighted_step(jacobian, error, problem.readiness, free, problem.damping, equations, step)
        vector += step


@kernel
def _subtract_product(matrix, vector, out):
    """Out - matrix vector, in place."""
    for a in range(matrix.shape[0]):
        for i in range(matrix.shape[1]):
            out[a] -= matrix[a, i] * vector[i]
