"""Bounded least squares in levels of priority: a kernel, exact, without heap.

    level by level:  min over u of |A_k u - b_k|^2   subject to  lower <= u <= upper
                     and A_j u as the levels j < k left it;      last of all  min |u|^2

(Escande, Mansard and Wieber, Hierarchical quadratic programming, IJRR 33(7), 2014, eq. (2)-(5)).
Each level is a primal active-set method in the null space of the levels above: a step leads to the
least-norm minimum over the free variables, or to the first bound, whose variable is then held; at
the minimum the held variable with the worst multiplier is freed (Nocedal and Wright, Numerical
Optimization, section 16.5). A variable is held only when a step moves it, so that held bounds and
levels above stay independent and the multipliers are unique. When a level is done, a variable with
a multiplier sits on its bound in every optimum of that level: it is fixed for good. The others are
free again, and what the level achieved becomes rows of an orthonormal `basis` that steps of later
levels are kept out of. No weight separates the levels, so that none bounds how exact they are.
"""

import numpy as np

from uvms_dynamics.kernels.jit import exact_inner, exact_kernel

FREE, AT_LOWER, AT_UPPER, FIXED = 0, -1, 1, 2
TOO_MANY_STEPS = -2
MULTIPLIER_TOLERANCE = 1e-12
"""A multiplier counts only beyond the rounding error of its terms."""
RANK_TOLERANCE = 1e-7
"""Share of a row outside of the others below which it depends on them: well above what rounding
leaves of a dependent row, well below what a layout has by intention."""
NOISE = 1e-13
"""A step this small, in shares of the thrust limits, is rounding error."""


def workspace(row_count, variable_count):
    """Arrays for `solve_levels`: float64 and int64."""
    width = max(row_count, variable_count)
    return np.zeros((5 * row_count + 6, width)), np.zeros((3, width), dtype=np.int64)


@exact_inner
def _dot(a, b, free, count):
    total = 0.0
    for k in range(count):
        total += a[free[k]] * b[free[k]]
    return total


@exact_inner
def _less(a, share, b):
    """a - share b, in all columns, into a."""
    for i in range(a.size):
        a[i] -= share * b[i]


@exact_inner
def _orthonormalise(rows, count, free, free_count):
    """Make rows orthonormal over the free columns, in place, by modified Gram-Schmidt, twice.

    The other columns follow. A row that depends on those before becomes zero.
    """
    for a in range(count):
        for _ in range(2):
            for b in range(a):
                _less(rows[a], _dot(rows[a], rows[b], free, free_count), rows[b])
        size = np.sqrt(_dot(rows[a], rows[a], free, free_count))
        scale = 1.0 / size if size > RANK_TOLERANCE else 0.0
        for i in range(rows.shape[1]):
            rows[a, i] *= scale


@exact_inner
def _list_free(state, free):
    count = 0
    for i in range(state.size):
        if state[i] == FREE:
            free[count] = i
            count += 1
    return count


@exact_inner
def _project(row, basis, spanned, free, count):
    """Take what the basis spans out of a row, over the free columns, and return its squared size.

    Twice, or rounding would leave a part of what is taken out.
    """
    for _ in range(2):
        for b in range(spanned):
            share = _dot(row, basis[b], free, count)
            for k in range(count):
                row[free[k]] -= share * basis[b, free[k]]
    return _dot(row, row, free, count)


@exact_inner
def _missing(rows, first, end, target, u, out):
    """b - A u of a level into `out`; returns the size of its largest term."""
    largest = 0.0
    for a in range(first, end):
        total = target[a]
        largest = max(largest, abs(total))
        for i in range(u.size):
            term = rows[a, i] * u[i]
            total -= term
            largest = max(largest, abs(term))
        out[a - first] = total
    return largest


@exact_inner
def _swap(rows, a, b):
    for i in range(rows.shape[1]):
        rows[a, i], rows[b, i] = rows[b, i], rows[a, i]


@exact_inner
def _independent(rows, first, end, basis, spanned, free, count, own, factor, missing):
    """Orthonormal rows `own` of a level outside of the basis, the largest part first; their number.

    Row a of the level is then sum_k factor[a, k] own[k] over the free columns; rows, and what is
    `missing` with them, are put in the order in which they were taken.
    """
    n, largest = end - first, 0.0
    for a in range(n):
        for i in range(own.shape[1]):
            own[a, i] = rows[first + a, i]
        for k in range(n):
            factor[a, k] = 0.0
        full = _dot_all(own[a])
        largest = max(largest, full)
        if _project(own[a], basis, spanned, free, count) <= RANK_TOLERANCE**2 * full:
            for k in range(count):
                own[a, free[k]] = 0.0
    for taken in range(n):
        best, squared = taken, -1.0
        for a in range(taken, n):
            its = _dot(own[a], own[a], free, count)
            if its > squared:
                best, squared = a, its
        if not squared > RANK_TOLERANCE**2 * largest:
            return taken
        size = np.sqrt(squared)
        if best != taken:
            _swap(own, best, taken)
            _swap(factor, best, taken)
            missing[best], missing[taken] = missing[taken], missing[best]
        if taken > 0:
            _project(own[taken], basis, spanned, free, count)
            _project(own[taken], own, taken, free, count)
            size = np.sqrt(_dot(own[taken], own[taken], free, count))
        factor[taken, taken] = size
        for k in range(count):
            own[taken, free[k]] /= size
        for a in range(taken + 1, n):
            share = _dot(own[a], own[taken], free, count)
            factor[a, taken] = share
            for k in range(count):
                own[a, free[k]] -= share * own[taken, free[k]]
    return n


@exact_inner
def _dot_all(a):
    total = 0.0
    for i in range(a.size):
        total += a[i] * a[i]
    return total


@exact_inner
def _solve_small(factor, n, taken, missing, upper, y):
    """Least squares: min |factor y - missing| for a tall factor (n, taken), which is spent."""
    for j in range(taken):
        size = 0.0
        for a in range(n):
            size += factor[a, j] * factor[a, j]
        size = np.sqrt(size)
        upper[j, j] = size
        y[j] = 0.0
        for a in range(n):
            factor[a, j] /= size
            y[j] += factor[a, j] * missing[a]
        for a in range(n):
            missing[a] -= y[j] * factor[a, j]
        for k in range(j + 1, taken):
            share = 0.0
            for a in range(n):
                share += factor[a, j] * factor[a, k]
            upper[j, k] = share
            for a in range(n):
                factor[a, k] -= share * factor[a, j]
    for j in range(taken - 1, -1, -1):
        for k in range(j + 1, taken):
            y[j] -= upper[j, k] * y[k]
        y[j] /= upper[j, j]


@exact_inner
def _walk(lower, upper, u, state, free, count, direction):
    """Move along `direction` to its end, or to the first bound; (reached the end, length)."""
    largest = 0.0
    for k in range(count):
        largest = max(largest, abs(direction[free[k]]))
    if largest <= NOISE:
        return True, 0.0
    length, blocking, side = 1.0, -1, FREE
    for k in range(count):
        i = free[k]
        if abs(direction[i]) <= NOISE * (1.0 + largest):
            continue
        bound, at = (upper[i], AT_UPPER) if direction[i] > 0.0 else (lower[i], AT_LOWER)
        reach = (bound - u[i]) / direction[i]
        if reach < length:
            length, blocking, side = max(reach, 0.0), i, at
    for k in range(count):
        i = free[k]
        u[i] = min(max(u[i] + length * direction[i], lower[i]), upper[i])
    if blocking < 0:
        return True, length
    state[blocking] = side
    u[blocking] = upper[blocking] if side == AT_UPPER else lower[blocking]
    return False, length


@exact_inner
def _multipliers(rows, first, end, target, u, state, q, spanned, free, count, missing, out):
    """Derivative of the level's error by each held variable, levels above as they are, into `out`.

    Returns what counts as zero of it. A level without rows is that of the least thrusts.
    """
    size = 1.0
    for i in range(u.size):
        out[i] = u[i] if first == end else 0.0
    if first < end:
        size = 0.0
        largest = _missing(rows, first, end, target, u, missing)
        for i in range(u.size):
            column = 0.0
            for a in range(first, end):
                out[i] -= rows[a, i] * missing[a - first]
                column += abs(rows[a, i])
            size = max(size, column * largest)
    for b in range(spanned):
        share = _dot(out, q[b], free, count)
        for i in range(u.size):
            if state[i] == AT_LOWER or state[i] == AT_UPPER:
                out[i] -= share * q[b, i]
    return MULTIPLIER_TOLERANCE * size


@exact_inner
def _release(multiplier, state, tolerance, first_come):
    """Free the held variable with the worst multiplier; False if none is wrong (optimal).

    `first_come`: the first wrong one instead, which ends what would go round in circles (Bland).
    """
    worst, which = tolerance, -1
    for i in range(state.size):
        if state[i] == AT_UPPER:
            wrong = multiplier[i]
        elif state[i] == AT_LOWER:
            wrong = -multiplier[i]
        else:
            continue
        if wrong > worst:
            worst, which = wrong, i
            if first_come:
                break
    if which < 0:
        return False
    state[which] = FREE
    return True


@exact_inner
def _close(multiplier, tolerance, state, basis, spanned, free):
    """Fix the variables that a level needs on their bounds and free the others."""
    fixes = False
    for i in range(state.size):
        if state[i] == AT_LOWER or state[i] == AT_UPPER:
            if abs(multiplier[i]) > tolerance:
                state[i], fixes = FIXED, True
                for b in range(spanned):
                    basis[b, i] = 0.0
            else:
                state[i] = FREE
    count = _list_free(state, free)
    if fixes:
        _orthonormalise(basis, spanned, free, count)
    return count


@exact_kernel
def solve_levels(rows, ends, target, lower, upper, u, work, whole, max_steps):
    """Lexicographic optimum in place, from any start `u`; the steps taken, or TOO_MANY_STEPS.

    Args:
        rows: of all levels (r, m), the first level's first; their sizes should be alike.
        ends: number of rows (p,) up to the end of each level.
        target: b (r,).
        lower, upper: bounds (m,), which may be infinite, or equal.
        u: start and result (m,).
        work, whole: from `workspace(r, m)`.
    """
    r, m = rows.shape
    basis, q, own = work[:r, :m], work[r : 2 * r, :m], work[2 * r : 3 * r, :m]
    factor, small = work[3 * r : 4 * r, :r], work[4 * r : 5 * r, :r]
    rest = work[5 * r :]
    direction, multiplier, missing, y = rest[0, :m], rest[1, :m], rest[2, :r], rest[3, :r]
    state, free = whole[0, :m], whole[1, :m]
    for i in range(m):
        u[i] = min(max(u[i], lower[i]), upper[i])
        state[i] = FIXED if lower[i] == upper[i] else FREE
    first, spanned, steps, tolerance = 0, 0, 0, 0.0
    for level in range(ends.size + 1):
        end = ends[level] if level < ends.size else first
        holds, stalled = False, 0
        while True:
            steps += 1
            if steps > max_steps:
                return TOO_MANY_STEPS
            count = _list_free(state, free)
            if count == 0 and not holds:
                return steps
            for b in range(spanned):
                for i in range(m):
                    q[b, i] = basis[b, i]
            if holds:
                _orthonormalise(q, spanned, free, count)
            if first == end:
                for i in range(m):
                    direction[i] = -u[i]
                _project(direction, q, spanned, free, count)
            else:
                _missing(rows, first, end, target, u, missing)
                taken = _independent(
                    rows, first, end, q, spanned, free, count, own, factor, missing
                )
                _solve_small(factor, end - first, taken, missing, small, y)
                for k in range(count):
                    total = 0.0
                    for b in range(taken):
                        total += y[b] * own[b, free[k]]
                    direction[free[k]] = total
            ended, length = _walk(lower, upper, u, state, free, count, direction)
            stalled = 0 if length > NOISE else stalled + 1
            if not ended:
                holds = True
                continue
            if not holds:
                break
            tolerance = _multipliers(
                rows, first, end, target, u, state, q, spanned, free, count, missing, multiplier
            )
            if not _release(multiplier, state, tolerance, stalled > 2 * m):
                break
        if level == ends.size:
            return steps
        count = _list_free(state, free)
        if holds:
            count = _close(multiplier, tolerance, state, basis, spanned, free)
        taken = _independent(
            rows, first, end, basis, spanned, free, count, own, factor, missing
        )
        for b in range(taken):
            for i in range(m):
                basis[spanned, i] = own[b, i] if state[i] == FREE else 0.0
            spanned += 1
        first = end
    return steps
