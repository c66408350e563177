"""Quadratic programs with box bounds by a primal active-set method: exact, warm started, no heap.

    min over u of  1/2 u^T H u + g^T u    subject to  lower <= u <= upper,    H > 0

Each variable is free or held at one of its bounds (`state` 0, -1 or +1). The loop minimises over
the free variables, walks towards that minimum until a bound is met, holds the variable there, and
once the minimum is reached frees the held variable with the most negative multiplier
(Nocedal and Wright, Numerical Optimization, section 16.5). H is positive definite and bounds are
linearly independent, so that a freed variable always moves and the objective strictly falls: no
set of held variables comes back, and the method ends after finitely many steps.

Own code because compiled kernels can call it, and for its speed: the whole allocation of a wrench
from Python takes as long as daqp's solution alone (ratio 0.95), 0.67 of quadprog's time and 0.09 of
that of scipy's bvls (`make bench ARGS=allocation`).
"""

import numpy as np

from uvms_dynamics.kernels.jit import exact_inner, exact_kernel

FREE, AT_LOWER, AT_UPPER = 0, -1, 1
NOT_POSITIVE_DEFINITE, TOO_MANY_STEPS = -1, -2
# A multiplier counts as wrong only beyond the rounding error of the gradient's terms.
MULTIPLIER_TOLERANCE = 1e-14


@exact_inner
def _factorise(hessian, free, count, factor):
    """Cholesky factor (lower) of the free block of the Hessian; False if it is not positive."""
    for i in range(count):
        for j in range(i + 1):
            total = hessian[free[i], free[j]]
            for k in range(j):
                total -= factor[i, k] * factor[j, k]
            if i == j:
                if not total > 0.0:
                    return False
                factor[i, i] = np.sqrt(total)
            else:
                factor[i, j] = total / factor[j, j]
    return True


@exact_inner
def _solve_factored(factor, count, x):
    """Solve L L^T x = x in place."""
    for i in range(count):
        for k in range(i):
            x[i] -= factor[i, k] * x[k]
        x[i] /= factor[i, i]
    for i in range(count - 1, -1, -1):
        for k in range(i + 1, count):
            x[i] -= factor[k, i] * x[k]
        x[i] /= factor[i, i]


@exact_inner
def _gradient(hessian, g, u, gradient):
    """H u + g into `gradient`; returns the size of its terms, the measure of its rounding error."""
    scale = 0.0
    for i in range(u.size):
        total, size = g[i], abs(g[i])
        for j in range(u.size):
            term = hessian[i, j] * u[j]
            total += term
            size += abs(term)
        gradient[i] = total
        scale = max(scale, size)
    return scale


@exact_inner
def _start(lower, upper, u, state):
    """Clip the warm start into the box; held variables sit exactly on their bounds."""
    for i in range(u.size):
        u[i] = min(max(u[i], lower[i]), upper[i])
        if lower[i] == upper[i]:
            state[i] = AT_UPPER
        if state[i] == AT_LOWER:
            u[i] = lower[i]
        elif state[i] == AT_UPPER:
            u[i] = upper[i]


@exact_inner
def _walk(lower, upper, u, state, free, count, direction):
    """Move along `direction` to its end (True) or to the first bound, which is then held."""
    length, blocking, side = 1.0, -1, FREE
    for k in range(count):
        i = free[k]
        if direction[k] > 0.0:
            bound, at = upper[i], AT_UPPER
        elif direction[k] < 0.0:
            bound, at = lower[i], AT_LOWER
        else:
            continue
        reach = (bound - u[i]) / direction[k]
        if reach < length:
            length, blocking, side = max(reach, 0.0), i, at
    for k in range(count):
        i = free[k]
        u[i] = min(max(u[i] + length * direction[k], lower[i]), upper[i])
    if blocking < 0:
        return True
    state[blocking] = side
    u[blocking] = upper[blocking] if side == AT_UPPER else lower[blocking]
    return False


@exact_inner
def _release(gradient, lower, upper, state, tolerance):
    """Free the held variable with the worst multiplier; False if none is wrong (optimal)."""
    worst, which = tolerance, -1
    for i in range(state.size):
        if state[i] == FREE or lower[i] == upper[i]:
            continue
        wrong = gradient[i] if state[i] == AT_UPPER else -gradient[i]
        if wrong > worst:
            worst, which = wrong, i
    if which < 0:
        return False
    state[which] = FREE
    return True


@exact_kernel
def solve_box_qp(hessian, g, lower, upper, u, state, max_steps):
    """Solve the box QP in place, from the warm start (u, state); returns the steps taken.

    Shapes: hessian (m, m) symmetric positive definite, g, lower, upper, u (m,) float64,
    state (m,) int64. Returns NOT_POSITIVE_DEFINITE or TOO_MANY_STEPS (negative) on failure.
    """
    m = u.size
    free = np.empty(m, np.int64)
    factor = np.empty((m, m))
    direction = np.empty(m)
    gradient = np.empty(m)
    _start(lower, upper, u, state)
    for step in range(max_steps):
        scale = _gradient(hessian, g, u, gradient)
        count = 0
        for i in range(m):
            if state[i] == FREE:
                free[count] = i
                direction[count] = -gradient[i]
                count += 1
        if not _factorise(hessian, free, count, factor):
            return NOT_POSITIVE_DEFINITE
        _solve_factored(factor, count, direction)
        if not _walk(lower, upper, u, state, free, count, direction):
            continue
        scale = _gradient(hessian, g, u, gradient)
        if not _release(gradient, lower, upper, state, MULTIPLIER_TOLERANCE * scale):
            return step + 1
    return TOO_MANY_STEPS


@exact_kernel
def solve_from(hessian, g, lower, upper, u, state, max_steps):
    """As `solve_box_qp`, once more from zero where the warm start takes too many steps.

    A bad warm start only costs steps; when it fails from zero too, something is wrong.
    """
    steps = solve_box_qp(hessian, g, lower, upper, u, state, max_steps)
    if steps == TOO_MANY_STEPS:
        for i in range(u.size):
            u[i], state[i] = 0.0, FREE
        steps = solve_box_qp(hessian, g, lower, upper, u, state, max_steps)
    return steps
