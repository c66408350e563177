"""Weighted least-squares thrust allocation within bounds, in scaled variables.

    min over u of  |W (B u - tau)|^2 + eps |u / u_max|^2    subject to  lower <= u <= upper

The rows are divided by the authority of each axis and the columns multiplied by the limit of each
thruster, so that newtons and newton metres compare, the weights W are free of units, and eps
weighs a share of thrust against a share of authority.
"""

from typing import Any, NoReturn

import numpy as np

from uvms_control.allocation.box_qp import solve_from
from uvms_control.errors import AllocationError
from uvms_core.signals import Array

# Each step of the active-set method holds or frees one thruster; a warm start needs a handful.
MAX_STEPS_PER_THRUSTER = 100


def box_of(limits: Array) -> Array:
    """Least and greatest thrusts (2, m), N, of limits (m,) in either direction, or those (2, m)."""
    values = np.array(limits, dtype=np.float64)
    return values if values.ndim == 2 else np.vstack([-values, values])


class BoundedLeastSquares:
    """Solver for one thruster layout; it remembers the last solution as its warm start."""

    def __init__(
        self,
        matrix: Array,
        limits: Array,
        weights: Array,
        regularisation: float,
        authority: Array | None = None,
    ):
        """`matrix` (6, m) wrench per newton, `weights` (6,) >= 0.

        `limits` (m,) N > 0 in either direction, or (2, m) N astern (<= 0) and ahead (> 0);
        `authority` (6,) N and N m by which errors are compared, by default that of the matrix.
        """
        self.matrix = np.ascontiguousarray(matrix, dtype=np.float64)
        self.lower, self.upper = box_of(limits)
        self.limits = np.maximum(-self.lower, self.upper)
        self._low, self._high = self.lower / self.limits, self.upper / self.limits
        if authority is None:
            authority = np.abs(self.matrix) @ self.limits
        self._row_scale = np.asarray(weights) / np.where(authority > 0.0, authority, 1.0)
        scaled = self._row_scale[:, None] * self.matrix * self.limits
        m = self.limits.size
        self._hessian = np.ascontiguousarray(scaled.T @ scaled + regularisation * np.eye(m))
        self._gradient_of_wrench = -scaled.T * self._row_scale
        self.max_steps = MAX_STEPS_PER_THRUSTER * max(m, 1)
        self.reset()

    def reset(self) -> None:
        """Forget the warm start."""
        self._u = np.zeros(self.limits.size)
        self._state = np.zeros(self.limits.size, dtype=np.int64)

    @property
    def tables(self) -> tuple[Array, Array, Array]:
        """Matrix (6, m), row scale (6,), limits (m,) N."""
        return self.matrix, self._row_scale, self.limits

    def problem(self, tau: Array) -> tuple[Any, None]:
        """The problem for the wrench `tau` (6,) as `solve_from` takes it: H, g, warm start."""
        warm_start = self._u.copy(), self._state.copy()
        return (self._hessian, self.gradient(tau), *warm_start), None

    def gradient(self, tau: Array) -> Array:
        """Gradient (m,) of the objective at no thrust, for the wrench `tau` (6,)."""
        return self._gradient_of_wrench @ tau

    def fail(self, tau: Array) -> NoReturn:
        """Raise AllocationError: no thrust was found for this wrench (6,)."""
        self.reset()
        raise AllocationError(
            f"no thrust found for the wrench {np.array2string(tau, precision=6)}: after "
            f"{self.max_steps} steps of the active-set method the optimum was not reached; "
            "raise allocation.regularisation or bring allocation.weights closer together"
        )

    def solve(self, tau: Array, lower: Array | None = None, upper: Array | None = None) -> Array:
        """Thrusts (m,) in N for the wrench `tau` (6,); bounds default to the limits themselves."""
        low = self._low if lower is None else lower / self.limits
        high = self._high if upper is None else upper / self.limits
        steps = solve_from(
            self._hessian, self.gradient(tau), low, high, self._u, self._state, self.max_steps
        )
        if steps < 0:
            self.fail(tau)
        bound_low = self.lower if lower is None else lower
        bound_high = self.upper if upper is None else upper
        return np.clip(self._u * self.limits, bound_low, bound_high)
