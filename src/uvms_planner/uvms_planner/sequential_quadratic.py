"""One step by sequential quadratic programming: the deterministic rival of the genetic algorithm.

The problem is that of eq. (17) with the cost of `fitness`: least cost along the end effector's
path, within the bounds of the increments and the limits of the free attitude. Each iteration solves
the quadratic program of the Gauss-Newton model along the tangent of the path, shortens its step
until the merit falls, and brings it back onto the path (Nocedal and Wright, Numerical Optimization,
2nd ed., ch. 18; the merit is the exact penalty of sec. 15.4).
"""

import numpy as np

from uvms_dynamics.kernels.jit import inner, kernel, shared
from uvms_planner.active_set import solve_program
from uvms_planner.constraints import free_attitude
from uvms_planner.fitness import cost
from uvms_planner.linear import copy_into
from uvms_planner.problem import VEHICLE, configuration_after
from uvms_planner.projection import configuration_jacobian, project, within_tolerance
from uvms_planner.refine import normal_equations

HALVINGS = 10
ATTITUDE_MARGIN = 1e-9  # rad inside the limits, so that rounding does not end beyond them
DIFFERENCE = 1e-5  # rad, for the slope of the free attitude
SLACKS = 2  # of roll and of pitch: a start beyond the limits has a program, too
FIRST_WEIGHT = 1e4  # of a radian beyond a limit, over the steepest slope of the cost


@kernel
def solve_step(model, problem, starts, iterations, tolerance):
    """The increment (m,) of least cost, from the best of `starts` (s, m).

    `tolerance` is the step that ends the search, in per-step ranges. Returns (found, increment,
    violation in rad, cost, evaluations, on_path): `found` is False where no start can be brought
    within e of the path.
    """
    size = problem.configuration.shape[0]
    best, trial, attitude = np.zeros(size), np.zeros(size), np.zeros(2)
    found, excess, value = False, np.inf, np.inf
    evaluations, on_path = 0, 0
    for s in range(starts.shape[0]):
        copy_into(trial, starts[s])
        valid, trial_excess, trial_value = _evaluate(model, problem, trial, attitude)
        evaluations += 1
        on_path += valid
        if valid and (trial_excess < excess or (trial_excess == excess and trial_value < value)):
            found, excess, value = True, trial_excess, trial_value
            copy_into(best, trial)
    if not found:
        return False, best, np.inf, np.inf, evaluations, on_path

    step = np.zeros(size)
    for _ in range(iterations):
        weight = _program(model, problem, best, step)
        if excess == 0.0 and _longest(problem, step) < tolerance:
            break
        merit, share, improved = value + weight * excess, 1.0, False
        for _try in range(HALVINGS):
            for i in range(size):
                trial[i] = best[i] + share * step[i]
            valid, trial_excess, trial_value = _evaluate(model, problem, trial, attitude)
            evaluations += 1
            on_path += valid
            if valid and trial_value + weight * trial_excess < merit:
                improved, excess, value = True, trial_excess, trial_value
                copy_into(best, trial)
                break
            share *= 0.5
        if not improved:
            break
    violation = excess - ATTITUDE_MARGIN if excess > ATTITUDE_MARGIN else 0.0
    return True, best, violation, value, evaluations, on_path


@inner
def _longest(problem, step):
    """Greatest component of a step, in per-step ranges."""
    longest = 0.0
    for i in range(step.shape[0]):
        if problem.reach[i] > 0.0:
            longest = max(longest, abs(step[i]) / problem.reach[i])
    return longest


@shared
def _evaluate(model, problem, increment, attitude):
    """Project `increment` in place; (valid, excess of the attitude in rad, cost)."""
    distance, angle = project(model, problem, increment)
    if not within_tolerance(problem, distance, angle):
        return False, np.inf, np.inf
    end = configuration_after(problem.configuration, increment)
    attitude[0], attitude[1] = free_attitude(model, end[VEHICLE:])
    excess = max(abs(attitude[0]) - problem.roll_max + ATTITUDE_MARGIN, 0.0)
    excess += max(abs(attitude[1]) - problem.pitch_max + ATTITUDE_MARGIN, 0.0)
    return True, excess, cost(model, problem, increment)


@shared
def _program(model, problem, increment, step):
    """Fill `step` (m,) with the solution of the quadratic program; the weight of the penalty.

    In per-step ranges. The attitude's limits come in only where the solution without them would
    break them. The penalty is exact where it weighs more than their multipliers; twice as much,
    since a much greater one forbids steps along a curved limit.
    """
    size = increment.shape[0]
    equations = 6 if problem.oriented else 3
    hessian, gradient = np.zeros((size, size)), np.zeros(size)
    normal_equations(model, problem, increment, hessian, gradient)
    end = configuration_after(problem.configuration, increment)
    jacobian = configuration_jacobian(model, end)
    reach = problem.reach
    wide, slope = np.zeros((size + SLACKS, size + SLACKS)), np.zeros(size + SLACKS)
    equal = np.zeros((equations, size + SLACKS))
    lower, upper = np.zeros(size + SLACKS), np.zeros(size + SLACKS)
    for i in range(size):
        slope[i] = gradient[i] * reach[i]
        for j in range(size):
            wide[i, j] = hessian[i, j] * reach[i] * reach[j]
        for a in range(equations):
            equal[a, i] = jacobian[a, i] * reach[i]
        if reach[i] > 0.0:
            lower[i] = (problem.lower[i] - increment[i]) / reach[i]
            upper[i] = (problem.upper[i] - increment[i]) / reach[i]
        lower[i], upper[i] = min(lower[i], 0.0), max(upper[i], 0.0)
    x = np.zeros(size + SLACKS)
    none, nothing, weight = np.zeros((0, size + SLACKS)), np.zeros(0), 0.0
    solve_program(
        wide[:size, :size].copy(), slope[:size].copy(), lower[:size].copy(), upper[:size].copy(),
        equal[:, :size].copy(), none[:, :size].copy(), nothing, x[:size], nothing,
    )  # fmt: skip
    rows, limits = np.zeros((2 * SLACKS, size + SLACKS)), np.zeros(2 * SLACKS)
    if _attitude_rows(model, problem, end, x, rows, limits):
        steepest = 0.0
        for i in range(size):
            x[i] = 0.0
            steepest = max(steepest, abs(slope[i]))
        heavy = FIRST_WEIGHT * steepest
        for k in range(SLACKS):
            i = size + k
            x[i] = max(-limits[2 * k], -limits[2 * k + 1], 0.0)
            upper[i], slope[i], wide[i, i] = np.inf, heavy, 1e-6 * heavy
        weights = np.zeros(2 * SLACKS)
        solve_program(wide, slope, lower, upper, equal, rows, limits, x, weights)
        for a in range(2 * SLACKS):
            weight = max(weight, 2.0 * weights[a])
    for i in range(size):
        step[i] = x[i] * reach[i]
    return weight


@shared
def _attitude_rows(model, problem, end, x, rows, limits):
    """Fill rows (4, m + 2) x <= limits (4,) of |roll| and |pitch|, each less its slack.

    Returns whether `x` (m + 2,) breaks one of them.
    """
    q = end[VEHICLE:].copy()
    roll, pitch = free_attitude(model, q)
    size = end.shape[0]
    for i in range(q.shape[0]):
        kept = q[i]
        q[i] = kept + DIFFERENCE
        moved_roll, moved_pitch = free_attitude(model, q)
        q[i] = kept
        scale = problem.reach[VEHICLE + i] / DIFFERENCE
        rows[0, VEHICLE + i] = (moved_roll - roll) * scale
        rows[2, VEHICLE + i] = (moved_pitch - pitch) * scale
    limits[0] = problem.roll_max - ATTITUDE_MARGIN - roll
    limits[1] = problem.roll_max - ATTITUDE_MARGIN + roll
    limits[2] = problem.pitch_max - ATTITUDE_MARGIN - pitch
    limits[3] = problem.pitch_max - ATTITUDE_MARGIN + pitch
    broken = False
    for k in range(SLACKS):
        for i in range(size):
            rows[2 * k + 1, i] = -rows[2 * k, i]
        rows[2 * k, size + k] = rows[2 * k + 1, size + k] = -1.0
    for a in range(2 * SLACKS):
        value = 0.0
        for i in range(size):
            value += rows[a, i] * x[i]
        broken = broken or value > limits[a]
    return broken
