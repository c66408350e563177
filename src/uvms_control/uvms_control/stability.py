"""Stability of the vehicle's loop along a run: V of eq. (27), its rate, and the condition of (29).

With e the error of pose, e_dot its rate (6,), P and D the slopes of the feedback near the reference
and b the wrench that following the reference takes,

    b = M nu_dot_d + C(nu) nu + D(nu) nu - F,      e_ddot = M^-1 (b - tau),

four numbers are worked out at a tick:

    V       = 1/2 e' [P + eps D - eps^2] e + 1/2 |e_dot + eps e|^2,         0 < eps < min D
    V_dot   = e' [P + eps D - eps^2] e_dot + (e_dot + eps e)' (e_ddot + eps e_dot)
    supply  = e_dot' tau                                                    W
    demand  = |e_dot|_M |b|_M^-1 = sqrt(e_dot' M e_dot) sqrt(b' M^-1 b)     W

V_dot is that of the loop as the law realises it by its own model: tau is the wrench, with all
limits of the law in it, and F what the observer sees acting ON the vehicle at its actual attitude.
With (22) e_ddot is the S-surface's own, -A S(e, e_dot); a law that leaves the righting moment or
the drag to the hull has them in e_ddot.

The condition below (29), supply >= demand, is sufficient and far from necessary: it asks that the
thrusters take more power out of the error's motion than the load could put in at its worst, and by
the load's size alone it does not see a load that is already carried. Corrections to the print:

- F_dis has the sign of a load there; here F acts on the vehicle.
- lambda_min(e_dot') tau, the least eigenvalue of a vector, is read as e_dot' tau, which (28) has.
- C(nu) e_dot is left out: its power e_dot' C e_dot is zero, as C is skew-symmetric (the paper uses
  the same in (28), for M and C together).
- The norms are those of M and M^-1 instead of the Euclidean ones, which add up m/s and rad/s and
  whose product depends on the unit of length; Cauchy's inequality holds for both.
- 1/2 e_dot' M e_dot of (27) is left out of V, see `s_surface.lyapunov`.
"""

import numpy as np

from uvms_control.errors import ControlSetupError
from uvms_core.signals import Array, Stability
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_dynamics.kernels.products import inner_product

EPSILON = 0.5
"""Of its bound min D; the middle, where neither of the two parts of -V_dot is small."""


class StabilityMonitor:
    """Works out `Stability` at every tick.

    Axes without feedback are left to the hull; they are in none of the figures.

    Args:
        stiffness: P (6,), 1/s^2, slope of the feedback acceleration against the error.
        damping: D (6,), 1/s, slope against the rate of the error.
    """

    def __init__(self, stiffness: Array, damping: Array) -> None:
        stiffness, damping = np.array(stiffness, dtype=float), np.array(damping, dtype=float)
        self._controlled = (stiffness > 0.0) & (damping > 0.0)
        half = (stiffness > 0.0) != (damping > 0.0)
        if stiffness.shape != (6,) or damping.shape != (6,) or half.any():
            raise ControlSetupError(
                f"stability: stiffness {stiffness} and damping {damping}, expected six of each,"
                " both above 0 or both 0 on every axis"
            )
        self.epsilon = EPSILON * float(np.min(damping, initial=np.inf, where=self._controlled))
        if not np.isfinite(self.epsilon):
            self.epsilon = 0.0  # no axis is controlled
        weight = stiffness + self.epsilon * damping - self.epsilon**2
        self.constants = weight, self.epsilon, self._controlled
        """Weight (6,), epsilon and controlled axes (6,), as `stability_figures` takes them."""

    def at(
        self,
        stamp: int,
        error: Array,
        rate: Array,
        inertia: Array,
        needed: Array,
        wrench: Array,
    ) -> Stability:
        """The four numbers at a stamp.

        Args:
            stamp: of the estimate, ns.
            error: e (6,), desired minus actual pose in the body frame, m and rad.
            rate: e_dot (6,), m/s and rad/s.
            inertia: M (6, 6), of the whole system.
            needed: b (6,), N and N m.
            wrench: tau (6,), N and N m, as far as the thrusters give it.
        """
        found = stability_figures(error, rate, inertia, needed, wrench, *self.constants)
        return Stability(stamp, *found)


@exact_kernel
def stability_figures(
    error: Array,
    rate: Array,
    inertia: Array,
    needed: Array,
    wrench: Array,
    weight: Array,
    epsilon: float,
    controlled: Array,
) -> tuple[float, float, float, float]:
    """V, V_dot, demand and supply of the axes that are `controlled` (6,) bool.

    weight (6,): P + eps D - eps^2. The error's acceleration comes from all axes; the power only
    from those that are controlled.
    """
    acceleration = _solved(inertia, needed - wrench)
    value, change, supply, kinetic = 0.0, 0.0, 0.0, 0.0
    block, load = np.eye(6), np.zeros(6)
    for i in range(6):
        if not controlled[i]:
            continue
        mixed = rate[i] + epsilon * error[i]
        value += 0.5 * (weight[i] * error[i] * error[i] + mixed * mixed)
        change += weight[i] * error[i] * rate[i] + mixed * (acceleration[i] + epsilon * rate[i])
        supply += rate[i] * wrench[i]
        load[i] = needed[i]
        for k in range(6):
            if controlled[k]:
                block[i, k] = inertia[i, k]
                kinetic += rate[i] * inertia[i, k] * rate[k]
    size = inner_product(load, _solved(block, load))
    demand = np.sqrt(max(kinetic, 0.0) * max(size, 0.0))
    return value, change, demand, supply


@exact_kernel
def _solved(matrix: Array, right: Array) -> Array:
    """Solution (6,) of matrix x = right, for a symmetric positive definite matrix (Cholesky)."""
    n = right.shape[0]
    low, x = np.zeros((n, n)), right.copy()
    for i in range(n):
        for j in range(i + 1):
            rest = matrix[i, j]
            for k in range(j):
                rest -= low[i, k] * low[j, k]
            low[i, j] = np.sqrt(rest) if i == j else rest / low[j, j]
        for k in range(i):
            x[i] -= low[i, k] * x[k]
        x[i] /= low[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            x[i] -= low[k, i] * x[k]
        x[i] /= low[i, i]
    return x
