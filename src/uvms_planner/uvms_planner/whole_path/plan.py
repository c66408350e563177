"""A plan over the whole path: the posture's spline, and the vehicle's position in closed form."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import kernel
from uvms_planner.segment import Samples
from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.plan_report import PlanReport, report_of
from uvms_planner.whole_path.sample import THRUST, WRENCHES, read_aim, sample_values, vehicle_motion
from uvms_planner.whole_path.sampled_bounds import sampled_bounds
from uvms_planner.whole_path.spline import basis_at, spline_values
from uvms_planner.whole_path.tool_motion import FRAME_COLUMNS
from uvms_planner.whole_path.tool_turn import WANTED_ROWS

INSTANTS = 12  # of each piece at which a plan is examined
CLOSELY = 8  # parts of what is between two instants, where a limit is near
NEAR = 0.02  # share of a limit that is left where it is near, beside what it changes by


@dataclass(frozen=True)
class PathPlan:
    """The motion of vehicle and joints along a whole path."""

    problem: PathProblem
    knots: Array
    coefficients: Array  # (K, d) of yaw and joints
    iterations: int

    @property
    def duration(self) -> float:
        """Length of the plan in s."""
        return float(self.knots[-1])

    def posture(self, times: Array) -> Array:
        """Yaw and joints with two derivatives at `times` (k,) s: (k, 3, d).

        Before the beginning and after the end it is that of the beginning and the end, where a plan
        rests.
        """
        inside = np.clip(np.asarray(times, dtype=float), 0.0, self.duration)
        return spline_values(basis_at(self.knots, inside), self.coefficients)

    def sample(self, times: Array) -> Samples:
        """The configuration c = (x, y, z, psi, q) with two derivatives at `times` (k,) s."""
        motion = self.posture(times)
        vehicle = _vehicle_motions(
            self.problem.model, motion, self.problem.target(np.asarray(times, dtype=float))
        )
        joined = np.concatenate([vehicle, motion], axis=2)
        return Samples(*(np.ascontiguousarray(joined[:, row]) for row in range(3)))

    def values(self, times: Array) -> Array:
        """Wrenches, motion, attitude, turn and thrust at `times` (k,) s, as in `sample`."""
        return plan_values(
            self.problem.model, self.problem.around, self.posture(times), self.problem.target(times)
        )

    @cached_property
    def report(self) -> PlanReport:
        """What the plan costs, and how near it comes to each limit and where.

        Where a limit is near, the plan is examined more closely: its greatest values may stand
        between two instants, at a point of the tool's path, where the jerk leaps.
        """
        times = self.instants()
        near = _near_a_limit(self.problem, self.values(times))
        gaps = np.flatnonzero(near[1:] | near[:-1])
        shares = np.arange(1, CLOSELY) / CLOSELY
        between = times[gaps, None] + np.diff(times)[gaps, None] * shares
        return self.report_at(np.sort(np.concatenate([times, between.ravel()])))

    def instants(self, each: int = INSTANTS) -> Array:
        """That many instants on each of the spline's pieces, and the last."""
        breaks = np.unique(self.knots)
        inner = breaks[:-1, None] + np.diff(breaks)[:, None] * (np.arange(each) / each)
        return np.append(inner.ravel(), breaks[-1])

    def report_at(self, times: Array) -> PlanReport:
        """The report of the instants `times` (k,) s, increasing."""
        return report_of(self.problem, times, self.posture(times), self.values(times))


def _near_a_limit(problem: PathProblem, values: Array) -> NDArray[np.bool_]:
    """Which of the instants (k,) come near a limit of the sampled values (k, v), or beyond it.

    Near is what goes on as before would come to by the next instant, or came from since the last.
    """
    bounds, sampled = sampled_bounds(problem), values[:, WRENCHES:]
    room = np.minimum(bounds.upper - sampled, sampled - bounds.lower) / bounds.scale
    moved = np.abs(np.diff(sampled, axis=0)) / bounds.scale
    most = np.maximum(np.vstack([moved[:1], moved]), np.vstack([moved, moved[-1:]]))
    return np.asarray((room < NEAR + most).any(axis=1))


@kernel
def _vehicle_motions(model, motion, target):
    """Position, velocity and acceleration (k, 3, 3) of the vehicle."""
    out = np.empty((motion.shape[0], 3, 3))
    frames, tool = np.empty((motion.shape[2], FRAME_COLUMNS)), np.empty((3, 3))
    aim, wanted = np.empty((3, 3)), np.empty((WANTED_ROWS, 3))
    for i in range(motion.shape[0]):
        read_aim(target, i, aim, wanted)
        vehicle_motion(model, motion[i], aim, frames, tool, out[i])
    return out


@kernel
def plan_values(model, around, motion, target):
    """All values of `sample.sample_values` at the instants of motion (k, 3, d): (k, values)."""
    thrust, close = around.shares.shape[0] > 0, around.margins.shape[0] > 0
    size = THRUST + around.shares.shape[0] + around.margins.shape[0]
    out = np.zeros((motion.shape[0], size))
    aim, wanted = np.empty((3, 3)), np.empty((WANTED_ROWS, 3))
    for i in range(motion.shape[0]):
        read_aim(target, i, aim, wanted)
        sample_values(
            model, around.shares, around.current, around.shapes, around.margins, motion[i], aim,
            wanted, True, thrust, close, out[i],
        )  # fmt: skip
    return out
