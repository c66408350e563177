"""The thrust allocator: one commanded wrench to thrusts within their limits.

Where thrusters saturate, somebody has to go short. `ThrustAllocator` allots by levels of priority:
attitude about the axes that could tip the vehicle first, then depth, heading, position. An axis
keeps all that it can have before the next level gets anything. `WeightedAllocator` has weights
instead of levels: an axis of low weight loses most, but those of high weight lose something too.
Preserving the direction, an option of both, scales the whole wrench down: its direction is kept,
but a shortage of heave force costs as much roll moment.

Both solve for commands. A thruster that has lost thrust, or one whose lag is compensated, gives a
known share of its command; its column of the matrix is scaled by that, and its limits stay those of
the command.
"""

from typing import TypeVar

import numpy as np

from uvms_control.allocation.authority import (
    axes_pushed_one_way,
    axes_without_authority,
    axis_authority,
)
from uvms_control.allocation.gap import ThrustGap
from uvms_control.allocation.lag import LagCompensation
from uvms_control.allocation.least_squares import BoundedLeastSquares, box_of
from uvms_control.allocation.lexicographic import AXES, LexicographicLeastSquares
from uvms_control.allocation.solver import Solver
from uvms_control.allocator_config import AllocatorConfig
from uvms_control.errors import ControlSetupError
from uvms_control.vehicle_data import least_thrusts, thruster_lags, thruster_limits
from uvms_core import checks
from uvms_core.errors import SignalError
from uvms_core.signals import Allocation, Array, ThrusterCommand, Wrench, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics import thruster_matrix
from uvms_dynamics.kernels.jit import exact_kernel

A = TypeVar("A", bound="ThrustAllocator")
LEAST_SHARE, GREATEST_SHARE = 0.0, 1.2
"""Share of its command that a thruster may be said to give: 0 dead, 1 whole; a fifth more than the
vehicle file says is within what its curve and battery leave open."""
# A thrust this close to its bound (share of the limit) counts as saturated.
SATURATION_MARGIN = 1e-9
# Bisections of the scale when the direction is preserved: 2^-40 of the wrench.
BISECTIONS = 40
# Residual (share of the authority of an axis) that counts as none.
EXACT = 1e-6
DEAD = 0.05
"""A thruster that gives less than this share of its command is left out: it would be driven at its
limit for next to nothing."""


class ThrustAllocator:
    """Thrusts by levels of priority (`allocation.priorities`), within limits, by exact steps.

    Thrusts that no drive can give, between none and its least, are left out (`ThrustGap`).

    Attributes:
        effectiveness: (m,) share of its command that each thruster is taken to give.
    """

    compensates = True
    """Whether commands go beyond wanted thrusts, as far as `allocation.lag_compensation` says."""

    def __init__(self, vehicle: Vehicle, config: AllocatorConfig):
        """`vehicle` from `uvms_core.vehicle.load_vehicle`; any number of thrusters."""
        limits, slew = thruster_limits(vehicle)
        lags, least = thruster_lags(vehicle), least_thrusts(vehicle)
        self._setup(thruster_matrix(vehicle), limits, slew, config, least, lags)

    @classmethod
    def from_layout(
        cls: type[A],
        matrix: Array,
        limits: Array,
        slew: Array,
        config: AllocatorConfig,
        least: Array | None = None,
        lags: Array | None = None,
    ) -> A:
        """From a thruster matrix (6, m) wrench per N, limits and slew limits (m,) N/s.

        Limits are (m,) N in either direction, or (2, m) N astern (<= 0) and ahead (> 0); `least`
        (2, m) N are the smallest thrusts but none, astern and ahead; `lags` (m,) s are the time
        constants, without which no lag is compensated.
        """
        allocator = cls.__new__(cls)
        none = np.zeros((2, np.size(slew)))
        allocator._setup(matrix, limits, slew, config, none if least is None else least, lags)
        return allocator

    def _setup(
        self,
        matrix: Array,
        limits: Array,
        slew: Array,
        config: AllocatorConfig,
        least: Array,
        lags: Array | None,
    ) -> None:
        self.lower, self.upper = box_of(limits)
        self.limits = np.maximum(-self.lower, self.upper)
        self._reverses = self.lower < 0.0
        _check_layout(matrix, self.lower, self.limits, slew)
        self.matrix, self._slew, self._config = matrix, slew, config
        self._box = np.vstack([self.lower, self.upper])
        self._gross = np.abs(matrix) @ self.limits
        self._row_scale = 1.0 / np.maximum(self._gross, 1e-9)
        self._margin = SATURATION_MARGIN * self.limits
        self._lag: LagCompensation | None = None
        if self.compensates and lags is not None and config.lag_compensation > 0.0:
            self._lag = LagCompensation(lags, slew, config.lag_compensation)
        self.effectiveness = np.ones(self.limits.size)
        self._gap: ThrustGap | None = None
        self._rebuild()
        if least.any():
            self._gap = ThrustGap(self._solver, least)
        self.reset()

    def _rebuild(self) -> None:
        """Solver and bounds for what the thrusters now make of their commands."""
        self._dead = self.effectiveness == 0.0
        self._any_dead = bool(self._dead.any())
        self._held = tuple(self._box * ~self._dead)
        self._given = self.matrix * self.effectiveness
        self._slope = self._given if self._lag is None else self._given * self._lag.slope
        self._solver = self._make_solver(self._slope)
        if self._gap is not None:
            self._gap = self._gap.of(self._solver)

    def _make_solver(self, matrix: Array) -> Solver:
        """The solver for a matrix (6, m) of wrenches per newton of command."""
        weights = np.array(self._config.weights)
        levels = [[AXES.index(axis) for axis in level] for level in self._config.priorities]
        return LexicographicLeastSquares(matrix, self._box, weights, levels, self._gross)

    def reset(self) -> None:
        """Forget the last thrust and the warm start; the effectiveness stays."""
        self._stamp: int | None = None
        self._thrust = np.zeros_like(self.limits)
        self._coming = np.zeros(6)
        self._solver.reset()
        if self._lag is not None:
            self._lag.reset()
            self._rebuild()
        if self._gap is not None:
            self._gap.reset()

    def set_effectiveness(self, effectiveness: Array) -> None:
        """From the next step on, each thruster gives this share (m,), 0 to 1.2, of its command.

        One below 0.05 is left out. What it costs, a fraction of a millisecond, is spent only where
        a share has changed.

        Raises SignalError for a wrong shape or a share outside of 0 to 1.2.
        """
        shares = np.asarray(effectiveness, dtype=np.float64)
        if shares.shape != self.limits.shape:
            raise SignalError(
                f"effectiveness has shape {shares.shape}; it must have ({self.limits.size},)"
            )
        for i in np.flatnonzero(~((shares >= LEAST_SHARE) & (shares <= GREATEST_SHARE))):
            raise SignalError(
                f"effectiveness[{i}] is {shares[i]}; it must be in {LEAST_SHARE:g} to"
                f" {GREATEST_SHARE:g}"
            )
        shares = np.where(shares < DEAD, 0.0, shares)
        if not np.array_equal(shares, self.effectiveness):
            self.effectiveness = shares
            self._rebuild()

    @property
    def authority(self) -> Array:
        """Largest force or moment along each axis (6,) with the others at zero, N and N m."""
        return axis_authority(self._given, self._box)

    @property
    def axes_without_authority(self) -> tuple[str, ...]:
        """Axes along which the thrusters cannot push without pushing along another."""
        return axes_without_authority(self._given)

    @property
    def axes_pushed_one_way(self) -> tuple[str, ...]:
        """Axes with authority in one direction alone, `Z (only +)`."""
        return axes_pushed_one_way(self._given, *self._held)

    @property
    def axes_left_out(self) -> tuple[str, ...]:
        """Axes whose commands are not followed, since that would be at the cost of others."""
        return tuple(AXES[axis] for axis in getattr(self._solver, "left_out", ()))

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

    def prepare(self, period: float) -> None:
        """Be told the control period, s; else it is the time between the first two commands."""
        if self._lag is not None:
            self._lag.prepare(period)
            self._rebuild()

    def step(self, wrench: Wrench) -> tuple[ThrusterCommand, Allocation]:
        """Thrusts for a commanded wrench (6,) at its stamp, and what they achieve.

        With the lag compensated, `achieved` is the wrench of the commands, which are ahead of the
        wanted thrusts, and `residual` what the wanted thrusts leave of the command.

        Raises SignalError for a wrench of a wrong shape or that is not finite.
        """
        checks.check("wrench_command", wrench)
        tau = wrench.wrench
        lower, upper = self._bounds(wrench.stamp)
        if self._lag is not None:
            if self._lag.advance(wrench.stamp):
                self._rebuild()
            self._coming, tau, lower, upper = self._lag.left(self._given, tau, lower, upper)
        if self._any_dead:
            lower, upper = np.where(self._dead, 0.0, lower), np.where(self._dead, 0.0, upper)
        thrust, tau_wanted = self._solver.solve(tau, lower, upper), tau
        if self._config.preserve_direction and not self._exact(thrust, tau):
            thrust = self._scaled(tau, lower, upper, thrust)
            tau_wanted = self._slope @ thrust
        if self._gap is not None:
            thrust = self._gap.left_out(tau_wanted, thrust, lower, upper)
        self._stamp, self._thrust = wrench.stamp, thrust
        return self._result(wrench.stamp, wrench.wrench, thrust, lower, upper)

    def safe(self, stamp: int) -> tuple[ThrusterCommand, Allocation]:
        """Zero thrust, for when the command is stale or missing."""
        self.reset()
        zero = np.zeros_like(self.limits)
        return self._result(stamp, np.zeros(6), zero, *self._box)

    def _result(
        self, stamp: int, tau: Array, thrust: Array, lower: Array, upper: Array
    ) -> tuple[ThrusterCommand, Allocation]:
        if self._lag is not None:
            self._lag.hold(stamp, thrust)
        wrenches, saturated = np.empty((2, 6)), np.empty(thrust.size, dtype=np.bool_)
        weigh(self._given, self._slope, self._coming, tau, thrust, wrenches)
        mark_saturated(thrust, lower, upper, self._margin, self._reverses, self._dead, saturated)
        command = ThrusterCommand(stamp, thrust)
        achieved, residual = wrenches
        return command, Allocation(stamp, thrust, achieved, residual, saturated, self.effectiveness)

    def _bounds(self, stamp: int) -> tuple[Array, Array]:
        """Bounds (m,) N of this tick: the limits, and what the slew limit reaches from the last."""
        lower, upper = self._held
        if self._config.slew_aware and self._stamp is not None:
            reach = self._slew * max(to_seconds(stamp - self._stamp), 0.0)
            lower = np.maximum(lower, self._thrust - reach)
            upper = np.minimum(upper, self._thrust + reach)
        return lower, upper

    def _exact(self, thrust: Array, tau: Array) -> bool:
        residual = self._row_scale * (self._slope @ thrust - tau)
        return bool(np.max(np.abs(residual)) <= EXACT)

    def _scaled(self, tau: Array, lower: Array, upper: Array, fallback: Array) -> Array:
        """Thrust for the largest share of the wrench that is attainable.

        Where none is (slew limits), the thrust of the levels stands.
        """
        assert isinstance(self._solver, LexicographicLeastSquares)
        thrust = self._solver.solve_along(tau, lower, upper)
        return fallback if thrust is None else thrust


class WeightedAllocator(ThrustAllocator):
    """min |W (B u - tau)|^2 + eps |u / u_max|^2 within the limits, by an active-set method.

    It commands the wanted thrusts themselves, whatever their lag.
    """

    compensates = False

    def _make_solver(self, matrix: Array) -> Solver:
        weights, regularisation = np.array(self._config.weights), self._config.regularisation
        return BoundedLeastSquares(matrix, self._box, weights, regularisation, self._gross)

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


@exact_kernel
def weigh(given, slope, coming, tau, thrust, wrenches):
    """Wrench achieved and what is left of `tau` (6,) into `wrenches` (2, 6).

    `given`, `slope` (6, m): wrench per newton of command, in the end and by the end of the period;
    `coming` (6,): what comes by then of the thrusts before.
    """
    for row in range(6):
        achieved, soon = 0.0, 0.0
        for i in range(thrust.size):
            achieved += given[row, i] * thrust[i]
            soon += slope[row, i] * thrust[i]
        wrenches[0, row], wrenches[1, row] = achieved, tau[row] - (soon + coming[row])


@exact_kernel
def mark_saturated(thrust, lower, upper, margin, reverses, dead, out):
    """Whether each thrust (m,) is at a bound into `out` (m,); one that rests is at none."""
    for i in range(thrust.size):
        at_lower = thrust[i] <= lower[i] + margin[i] and reverses[i]
        out[i] = (at_lower or thrust[i] >= upper[i] - margin[i]) and not dead[i]


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
