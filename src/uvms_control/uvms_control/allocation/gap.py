"""Thrusts that no drive can give: between none and the least with which it begins to turn.

The least-squares thrust is continuous, so it can lie in that gap. Such a thruster is then either
stopped or set to its least thrust, whichever leaves the smaller error once the other thrusters have
made up for it, one thruster after the other: the one that is moved least comes first. To decide
each on its own at the middle of its gap is the other way, which is taken where it is better. Either
way thrusters stay as they were at the last tick unless the other choice is clearly better, since a
command near the middle of a gap would otherwise switch them at every tick.
"""

import numpy as np
from numpy.typing import NDArray

from uvms_control.allocation.least_squares import BoundedLeastSquares
from uvms_core.signals import Array
from uvms_core.vehicle.thrust_curve import nearest_reachable

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

    def __init__(self, solver: BoundedLeastSquares, least: Array) -> None:
        self._solver, self._least = solver, least
        self._inside = least + np.array([[1.0], [-1.0]]) * NONE * solver.limits
        self.reset()

    def reset(self) -> None:
        """Forget which thrusters turn."""
        self._turns = np.zeros(self._least.shape[1], dtype=np.bool_)

    def left_out(self, tau: Array, thrust: Array, lower: Array, upper: Array) -> Array:
        """Thrusts (m,) N outside of the gaps, for the least-squares thrusts (m,) of a wrench (6,).

        `lower` and `upper` (m,) are the bounds of this tick.
        """
        if self._in_gap(thrust).any():
            warm = self._solver.warm_start
            found = self._one_by_one(tau, thrust, lower.copy(), upper.copy())
            self._solver.warm_start = warm
            thrust = self._better(tau, found, self._rounded(thrust))
        self._turns = self._turning(thrust)
        return np.where(self._turns, thrust, 0.0)

    def _turning(self, thrust: Array) -> NDArray[np.bool_]:
        return np.abs(thrust) > NONE * self._solver.limits

    def _one_by_one(self, tau: Array, thrust: Array, low: Array, high: Array) -> Array:
        for _ in range(thrust.size):
            inside = self._in_gap(thrust)
            if not inside.any():
                break
            i, edge = self._first(thrust, inside)
            thrust = self._decided(tau, i, edge, low, high)
        return thrust

    def _rounded(self, thrust: Array) -> Array:
        return nearest_reachable(thrust, *self._least)

    def _better(self, tau: Array, one: Array, two: Array) -> Array:
        """The second where it is clearly better, or as good and the thrusters turn as they did."""
        keeps = [np.array_equal(self._turning(each), self._turns) for each in (one, two)]
        last, other = (two, one) if keeps == [False, True] else (one, two)
        errors = self._solver.error(tau, last), self._solver.error(tau, other)
        return other if errors[1] < BETTER * errors[0] - ALIKE else last

    def _in_gap(self, thrust: Array) -> Array:
        astern, ahead = self._inside
        none = NONE * self._solver.limits
        return ((thrust < -none) & (thrust > astern)) | ((thrust > none) & (thrust < ahead))

    def _first(self, thrust: Array, inside: Array) -> tuple[int, float]:
        """The thruster that is nearest to what it can give, and its least thrust in that sense."""
        edges = np.where(thrust > 0.0, self._least[1], self._least[0])
        moved = np.minimum(np.abs(thrust), np.abs(edges - thrust)) / self._solver.limits
        i = int(np.argmin(np.where(inside, moved, np.inf)))
        return i, float(edges[i])

    def _decided(self, tau: Array, i: int, edge: float, low: Array, high: Array) -> Array:
        """The thrusts with thruster i at none or at its edge, which becomes both its bounds."""
        found = {}
        for value in (0.0, edge):
            low[i] = high[i] = value
            thrust = self._solver.solve(tau, low, high)
            found[value] = self._solver.error(tau, thrust), thrust
        last, other = (edge, 0.0) if self._turns[i] else (0.0, edge)
        best = other if found[other][0] < BETTER * found[last][0] - ALIKE else last
        low[i] = high[i] = best
        return found[best][1]
