"""Gauss-Newton polish of a candidate along the end-effector constraint.

Without it the bits of the last improvement would shake the vehicle from step to step.
"""

import numpy as np

from uvms_dynamics.kernels.jit import inner, shared
from uvms_planner.constraints import better
from uvms_planner.fitness import judge, judged_disturbance
from uvms_planner.linear import copy_into, solve_in_place
from uvms_planner.problem import configuration_after
from uvms_planner.projection import configuration_jacobian, tool_error

DIFFERENCE = 1e-4  # of a variable's reach
HALVINGS = 4


@inner
def normal_equations(model, problem, increment, hessian, gradient):
    """Fill A^T A (m, m) and A^T rho (m,) of the cost's residuals rho about `increment` (m,).

    The residuals are the self-disturbance (twelve, differentiated numerically) and the weighted
    motion and change of motion of every variable (linear).
    """
    size, reach = increment.shape[0], problem.reach
    start, previous, h = problem.configuration, problem.previous, problem.step
    lookahead, combined = problem.lookahead, problem.combined
    wrench = judged_disturbance(model, start, previous, increment, h, lookahead, combined)
    slope = np.zeros((12, size))
    for i in range(size):
        if reach[i] <= 0.0:
            continue
        delta = DIFFERENCE * reach[i]
        kept = increment[i]
        increment[i] = kept + delta
        moved = judged_disturbance(model, start, previous, increment, h, lookahead, combined)
        increment[i] = kept
        for a in range(12):
            slope[a, i] = (moved[a] - wrench[a]) / delta
    for i in range(size):
        gradient[i] = 0.0
        for a in range(12):
            gradient[i] += slope[a, i] * wrench[a]
        for j in range(size):
            hessian[i, j] = 0.0
            for a in range(12):
                hessian[i, j] += slope[a, i] * slope[a, j]
    for i in range(size):
        if problem.reach[i] > 0.0:
            change = problem.smoothness_weight / problem.jump[i] ** 2
            motion = problem.motion_weights[i] / problem.reach[i] ** 2
            gradient[i] += change * (increment[i] - problem.previous[i]) + motion * increment[i]
            hessian[i, i] += change + motion + 1e-9 / problem.reach[i] ** 2


@inner
def constrained_step(problem, increment, hessian, gradient, jacobian, error, step):
    """Fill `step` (m,) with the minimizer of the quadratic model, J step = error, within bounds.

    Lagrange's equations over the free variables; those that would leave their bounds are held at
    them, and the rest solved again. Returns False where the equations are singular.
    """
    size = increment.shape[0]
    equations = 6 if problem.oriented else 3
    held = np.zeros(size, dtype=np.bool_)
    for i in range(size):
        step[i] = 0.0
        held[i] = problem.upper[i] <= problem.lower[i]
    for _ in range(size):
        matrix = np.zeros((size + equations, size + equations))
        vector = np.zeros(size + equations)
        for i in range(size):
            if held[i]:
                matrix[i, i] = 1.0
                vector[i] = step[i]
                continue
            vector[i] = -gradient[i]
            for j in range(size):
                matrix[i, j] = hessian[i, j]
            for a in range(equations):
                matrix[i, size + a] = jacobian[a, i]
        for a in range(equations):
            vector[size + a] = error[a]
            matrix[size + a, size + a] = -1e-12
            for i in range(size):
                matrix[size + a, i] = jacobian[a, i]
        if not solve_in_place(matrix, vector, size + equations):
            return False
        again = False
        for i in range(size):
            low, high = problem.lower[i] - increment[i], problem.upper[i] - increment[i]
            step[i] = min(max(vector[i], low), high)
            if not held[i] and step[i] != vector[i]:
                held[i] = True
                again = True
        if not again:
            return True
    return True


@shared
def refine(model, problem, increment, violation, cost, rounds):
    """Improve `increment` (m,) in place, at most `rounds` steps; return (violation, cost, judged).

    A step counts only if the projected candidate is better by Deb's rule, else it is halved.
    """
    size = increment.shape[0]
    hessian, gradient = np.zeros((size, size)), np.zeros(size)
    error, step, trial = np.zeros(6), np.zeros(size), np.zeros(size)
    judged = 0
    for _ in range(rounds):
        normal_equations(model, problem, increment, hessian, gradient)
        end = configuration_after(problem.configuration, increment)
        tool_error(model, end, problem.position, problem.rotation, problem.oriented, error)
        jacobian = configuration_jacobian(model, end)
        if not constrained_step(problem, increment, hessian, gradient, jacobian, error, step):
            break
        improved, share = False, 1.0
        for _try in range(HALVINGS):
            for i in range(size):
                trial[i] = increment[i] + share * step[i]
            valid, trial_violation, trial_cost = judge(model, problem, trial)
            judged += 1
            if valid and better(trial_violation, trial_cost, violation, cost):
                copy_into(increment, trial)
                violation, cost = trial_violation, trial_cost
                improved = True
                break
            share *= 0.5
        if not improved:
            break
    return violation, cost, judged
