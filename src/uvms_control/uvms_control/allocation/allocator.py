"""The thrust allocator: one commanded wrench to thrusts within their limits.

Weighted least squares is the default: when thrusters saturate, the axes of low weight lose their
share first, so that roll and pitch (by which the arm would tip the vehicle) keep their moment while
the force that holds position falls short for a while. Preserving the direction instead scales the
whole wrench down: its direction is kept, but a shortage of heave force costs as much roll moment.
Where the arm disturbs the attitude, the first is the better choice; the second is an option.
"""

import numpy as np

from uvms_control.allocation.authority import (
    axes_pushed_one_way,
    axes_without_authority,
    axis_authority,
)
from uvms_control.allocation.gap import ThrustGap
from uvms_control.allocation.least_squares import BoundedLeastSquares, box_of
from uvms_control.allocator_config import AllocatorConfig
from uvms_control.errors import ControlSetupError
from uvms_control.vehicle_data import least_thrusts, thruster_limits
from uvms_core import checks
from uvms_core.signals import Allocation, Array, ThrusterCommand, Wrench, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix

# A thrust this close to its bound (share of the limit) counts as saturated.
SATURATION_MARGIN = 1e-9
# Bisections of the scale when the direction is preserved: 2^-40 of the wrench.
BISECTIONS = 40
# Residual (share of the authority of an axis) that counts as none.
EXACT = 1e-6


class ThrustAllocator:
    """min |W (B u - tau)|^2 + eps |u / u_max|^2 within the limits, by an active-set method.

    Thrusts that no drive can give, between none and its least, are left out (`ThrustGap`).
    """

    def __init__(self, vehicle: Vehicle, config: AllocatorConfig):
        """`vehicle` from `uvms_core.vehicle.load_vehicle`; any number of thrusters."""
        matrix = thruster_matrix(vehicle)
        limits, slew = thruster_limits(vehicle)
        self._setup(matrix, limits, slew, config, least_thrusts(vehicle))

    @classmethod
    def from_layout(
        cls,
        matrix: Array,
        limits: Array,
        slew: Array,
        config: AllocatorConfig,
        least: Array | None = None,
    ) -> "ThrustAllocator":
        """From a thruster matrix (6, m) wrench per N, limits and slew limits (m,) N/s.

        Limits are (m,) N in either direction, or (2, m) N astern (<= 0) and ahead (> 0); `least`
        (2, m) N are the smallest thrusts but none, astern and ahead.
        """
        allocator = cls.__new__(cls)
        none = np.zeros((2, np.size(slew)))
        allocator._setup(matrix, limits, slew, config, none if least is None else least)
        return allocator

    def _setup(
        self, matrix: Array, limits: Array, slew: Array, config: AllocatorConfig, least: Array
    ) -> None:
        self.lower, self.upper = box_of(limits)
        self.limits = np.maximum(-self.lower, self.upper)
        self._reverses = self.lower < 0.0
        _check_layout(matrix, self.lower, self.limits, slew)
        self.matrix, self._slew = matrix, slew
        self._config = config
        box, weights = np.vstack([self.lower, self.upper]), np.array(config.weights)
        self._solver = BoundedLeastSquares(matrix, box, weights, config.regularisation)
        self._gap = ThrustGap(self._solver, least) if least.any() else None
        self._row_scale = 1.0 / np.maximum(np.abs(matrix) @ self.limits, 1e-9)
        self.axes_without_authority = axes_without_authority(matrix)
        self.axes_pushed_one_way = axes_pushed_one_way(matrix, self.lower, self.upper)
        self.reset()

    def reset(self) -> None:
        """Forget the last thrust and the warm start."""
        self._stamp: int | None = None
        self._thrust = np.zeros_like(self.limits)
        self._solver.reset()
        if self._gap is not None:
            self._gap.reset()

    @property
    def authority(self) -> Array:
        """Largest force or moment along each axis (6,) with the others at zero, N and N m."""
        return axis_authority(self.matrix, np.vstack([self.lower, self.upper]))

    @property
    def warning(self) -> str | None:
        """What this layout cannot do, or None if it can push both ways along every axis."""
        lacks = []
        if self.axes_without_authority:
            lacks.append(f"independently along {', '.join(self.axes_without_authority)}")
        if self.axes_pushed_one_way:
            lacks.append(f"both ways along {', '.join(self.axes_pushed_one_way)}")
        if not lacks:
            return None
        return (
            f"the {self.limits.size} thrusters cannot push {', nor '.join(lacks)}; commands there"
            " leave a residual"
        )

    def step(self, wrench: Wrench) -> tuple[ThrusterCommand, Allocation]:
        """Thrusts for a commanded wrench (6,) at its stamp, and what they achieve.

        Raises SignalError for a wrench of a wrong shape or that is not finite.
        """
        checks.check("wrench_command", wrench)
        tau = wrench.wrench
        lower, upper = self._bounds(wrench.stamp)
        thrust, tau_wanted = self._solver.solve(tau, lower, upper), tau
        if self._config.preserve_direction and not self._exact(thrust, tau):
            thrust = self._scaled(tau, lower, upper, thrust)
            tau_wanted = self.matrix @ thrust
        if self._gap is not None:
            thrust = self._gap.left_out(tau_wanted, thrust, lower, upper)
        self._stamp, self._thrust = wrench.stamp, thrust
        return self._result(wrench.stamp, tau, thrust, lower, upper)

    def safe(self, stamp: int) -> tuple[ThrusterCommand, Allocation]:
        """Zero thrust, for when the command is stale or missing."""
        self.reset()
        zero = np.zeros_like(self.limits)
        return self._result(stamp, np.zeros(6), zero, self.lower, self.upper)

    def _result(
        self, stamp: int, tau: Array, thrust: Array, lower: Array, upper: Array
    ) -> tuple[ThrusterCommand, Allocation]:
        achieved = self.matrix @ thrust
        margin = SATURATION_MARGIN * self.limits
        saturated = ((thrust <= lower + margin) & self._reverses) | (thrust >= upper - margin)
        command = ThrusterCommand(stamp, thrust)
        return command, Allocation(stamp, thrust, achieved, tau - achieved, saturated)

    def _bounds(self, stamp: int) -> tuple[Array, Array]:
        """Bounds (m,) N of this tick: the limits, and what the slew limit reaches from the last."""
        if not self._config.slew_aware or self._stamp is None:
            return self.lower, self.upper
        reach = self._slew * max(to_seconds(stamp - self._stamp), 0.0)
        lower = np.maximum(self.lower, self._thrust - reach)
        return lower, np.minimum(self.upper, self._thrust + reach)

    def _exact(self, thrust: Array, tau: Array) -> bool:
        residual = self._row_scale * (self.matrix @ thrust - tau)
        return bool(np.max(np.abs(residual)) <= EXACT)

    def _scaled(self, tau: Array, lower: Array, upper: Array, fallback: Array) -> Array:
        """Thrust for the largest share of the wrench that is attainable, by bisection.

        Attainable shares form an interval that starts at zero (the bounds are convex); where even
        a zero wrench is out of reach (slew limits), the least-squares thrust stands.
        """
        best = self._solver.solve(np.zeros(6), lower, upper)
        if not self._exact(best, np.zeros(6)):
            return fallback
        low, high = 0.0, 1.0
        for _ in range(BISECTIONS):
            share = 0.5 * (low + high)
            thrust = self._solver.solve(share * tau, lower, upper)
            if self._exact(thrust, share * tau):
                low, best = share, thrust
            else:
                high = share
        return best


def _check_layout(matrix: Array, lower: Array, limits: Array, slew: Array) -> None:
    m = np.size(limits)
    if np.shape(matrix) != (6, m) or m == 0:
        raise ControlSetupError(f"thruster matrix: shape {np.shape(matrix)}, expected (6, {m})")
    if np.shape(slew) != (m,):
        raise ControlSetupError(f"thruster slew limits: shape {np.shape(slew)}, expected ({m},)")
    if not np.isfinite(matrix).all():
        raise ControlSetupError("thruster matrix: holds a value that is not finite")
    for name, values in (("limits", limits), ("slew limits", slew)):
        if not (values > 0.0).all():
            raise ControlSetupError(f"thruster {name}: {values}, expected positive numbers")
    if (lower > 0.0).any():
        raise ControlSetupError(f"thruster limits astern: {lower}, expected none above 0")
