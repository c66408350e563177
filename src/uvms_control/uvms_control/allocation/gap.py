"""Thrusts that no drive can give: between none and the least with which it begins to turn.

The least-squares thrust is continuous, so it can lie in that gap. Such a thruster is then either
stopped or set to its least thrust, whichever leaves the smaller error once the other thrusters have
made up for it, one thruster after the other: the one that is moved least comes first. To decide
each on its own at the middle of its gap is the other way, which is taken where it is better. Either
way thrusters stay as they were at the last tick unless the other choice is clearly better, since a
command near the middle of a gap would otherwise switch them at every tick.
"""

import numpy as np

from uvms_control.allocation.box_qp import solve_from
from uvms_control.allocation.levels import solve_levels
from uvms_control.allocation.solver import Solver
from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_inner, exact_kernel

BETTER = 0.7
"""A thruster is started or stopped where that leaves less than this share of the squared error: for
a single one that is at 0.54 and 0.46 of its least thrust."""
ALIKE = 1e-10
"""Squared errors, as shares of the authority, that are alike: 1e-5 of it is far below any noise."""
NONE = 1e-9
"""Share of the limit below which a thrust is none."""


class ThrustGap:
    """Moves thrusts out of their gaps; it remembers which thrusters turn.

    Args:
        solver: of the layout.
        least: smallest thrusts but none (2, m), N, astern (<= 0) and ahead (>= 0).
    """

    def __init__(self, solver: Solver, least: Array) -> None:
        self._solver = solver
        self._tables = (*solver.tables, np.ascontiguousarray(least, dtype=np.float64))
        self.reset()

    def of(self, solver: Solver) -> "ThrustGap":
        """The same for a new solver; the thrusters that turn go on turning."""
        changed = ThrustGap(solver, self._tables[-1])
        changed._turns = self._turns
        return changed

    def reset(self) -> None:
        """Forget which thrusters turn."""
        self._turns = np.zeros(self._solver.limits.size, dtype=np.bool_)

    def left_out(self, tau: Array, thrust: Array, lower: Array, upper: Array) -> Array:
        """Thrusts (m,) N outside of the gaps, for the least-squares thrusts (m,) of a wrench (6,).

        `lower` and `upper` (m,) are the bounds of this tick.
        """
        solver, found = self._solver, thrust.copy()
        steps = leave_out(
            self._tables, *solver.problem(tau), tau, lower, upper, solver.max_steps, self._turns,
            found,
        )  # fmt: skip
        if steps < 0:
            solver.fail(tau)
        return found


@exact_kernel
def leave_out(tables, weighted, levels, tau, lower, upper, max_steps, turns, thrust):
    """Move `thrust` (m,) out of the gaps and note in `turns` (m,) which thrusters then turn.

    `tables` are those of the solver and the least thrusts. The problem that is solved again for the
    wrench `tau` (6,) is either the `weighted` one or that in `levels`, the other is None. Returns a
    negative number where the solver fails.
    """
    limits, least, steps = tables[2], tables[3], 0
    if _nearest_edge(limits, least, thrust) >= 0:
        rounded = np.empty_like(thrust)
        for i in range(thrust.size):
            rounded[i] = _rounded(least, thrust[i], i)
        steps = _one_by_one(tables, weighted, levels, tau, lower, upper, max_steps, turns, thrust)
        if _is_better(tables, tau, turns, thrust, rounded):
            _copy_into(thrust, rounded)
    for i in range(thrust.size):
        turns[i] = _is_turning(limits, thrust[i], i)
        if not turns[i]:
            thrust[i] = 0.0
    return steps


@exact_inner
def _solve(weighted, levels, low, high, limits, max_steps, found):
    """Thrusts (m,) N within the bounds into `found`; negative where the solver fails."""
    low_share, high_share, steps = low / limits, high / limits, 0
    if weighted is not None:  # the compiler leaves out the branch of the one that is None
        hessian, g, u, state = weighted
        steps = solve_from(hessian, g, low_share, high_share, u, state, max_steps)
        _bounded(u, limits, low, high, found)
    if levels is not None:
        rows, ends, target, u, work, whole = levels
        steps = solve_levels(rows, ends, target, low_share, high_share, u, work, whole, max_steps)
        _bounded(u, limits, low, high, found)
    return steps


@exact_inner
def _bounded(u, limits, low, high, found):
    for k in range(found.size):
        found[k] = min(max(u[k] * limits[k], low[k]), high[k])


@exact_inner
def _is_turning(limits, thrust, i):
    return abs(thrust) > NONE * limits[i]


@exact_inner
def _edge(least, thrust, i):
    """The least thrust of thruster i in the sense of a thrust."""
    return least[1, i] if thrust > 0.0 else least[0, i]


@exact_inner
def _rounded(least, thrust, i):
    """The thrust of thruster i nearest to a wanted one, as `ThrustTable.reachable`."""
    edge = _edge(least, thrust, i)
    if abs(thrust) >= abs(edge):
        return thrust
    return edge if abs(thrust) > 0.5 * abs(edge) else 0.0


@exact_inner
def _nearest_edge(limits, least, thrust):
    """The thruster in its gap that is nearest to what it can give; -1: none is in its gap."""
    first, nearest = -1, np.inf
    for i in range(thrust.size):
        edge, size = _edge(least, thrust[i], i), abs(thrust[i])
        if not NONE * limits[i] < size < abs(edge) - NONE * limits[i]:
            continue
        moved = min(size, abs(edge - thrust[i])) / limits[i]
        if moved < nearest:
            first, nearest = i, moved
    return first


@exact_inner
def _one_by_one(tables, weighted, levels, tau, lower, upper, max_steps, turns, thrust):
    """Decide one thruster after the other, in place; negative where the solver fails."""
    limits, least = tables[2], tables[3]
    low, high = lower.copy(), upper.copy()
    for _ in range(thrust.size):
        i = _nearest_edge(limits, least, thrust)
        if i < 0:
            break
        steps = _decide(tables, weighted, levels, tau, low, high, max_steps, turns, thrust, i)
        if steps < 0:
            return steps
    return 0


@exact_inner
def _decide(tables, weighted, levels, tau, low, high, max_steps, turns, thrust, i):
    """Set thruster i to none or to its edge, which becomes both its bounds, and solve again."""
    edge, stopped = _edge(tables[3], thrust[i], i), np.empty_like(thrust)
    for value, found in ((0.0, stopped), (edge, thrust)):
        low[i] = high[i] = value
        steps = _solve(weighted, levels, low, high, tables[2], max_steps, found)
        if steps < 0:
            return steps
    at_none, at_edge = _error(tables, tau, stopped), _error(tables, tau, thrust)
    if turns[i]:
        stops = at_none < BETTER * at_edge - ALIKE
    else:
        stops = not at_edge < BETTER * at_none - ALIKE
    if stops:
        low[i] = high[i] = 0.0
        _copy_into(thrust, stopped)
    return 0


@exact_inner
def _copy_into(out, values):
    for i in range(out.size):
        out[i] = values[i]


@exact_inner
def _is_better(tables, tau, turns, one, two):
    """Whether the second is clearly better, or as good and the thrusters turn as they did."""
    keeps_one, keeps_two = True, True
    for i in range(turns.size):
        keeps_one = keeps_one and _is_turning(tables[2], one[i], i) == turns[i]
        keeps_two = keeps_two and _is_turning(tables[2], two[i], i) == turns[i]
    first, second = _error(tables, tau, one), _error(tables, tau, two)
    if keeps_two and not keeps_one:
        return not first < BETTER * second - ALIKE
    return second < BETTER * first - ALIKE


@exact_inner
def _error(tables, tau, thrust):
    """Weighted squared error of the wrench of thrusts (m,) N, as a share of the authority."""
    matrix, row_scale, total = tables[0], tables[1], 0.0
    for row in range(6):
        missing = -tau[row]
        for i in range(thrust.size):
            missing += matrix[row, i] * thrust[i]
        total += (row_scale[row] * missing) ** 2
    return total
