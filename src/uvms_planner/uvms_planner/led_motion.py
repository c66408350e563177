"""The tool led by targets that come one by one, with no path and no end that is known.

Each target begins a motion anew from where the planned one is, moving or not: the tool goes there
along a quintic that ends at rest, and the window of the whole-path method finds yaw and joints for
it. So limits are kept whatever is asked, and where no more targets come the tool comes to rest at
the last one.
"""

from dataclasses import dataclass

import numpy as np

from uvms_core.end_effector_path import PathSamples
from uvms_core.errors import SignalError
from uvms_core.pointing import Directions
from uvms_core.signals import Array, to_seconds
from uvms_planner.errors import GoalRejected
from uvms_planner.problem import VEHICLE
from uvms_planner.segment import Knot, Samples, evaluate, quintic, tool_positions
from uvms_planner.solver import StepSolver, posture_of
from uvms_planner.timed_motion import TimedMotion
from uvms_planner.whole_path.window import SHORTEST_S, PathWindow, TimedPlan

PEAK = 15.0 / 8.0  # greatest speed of a quintic from rest to rest over its mean
LONGER = 1.5  # from one time that is tried to the next
TRIALS = 6
DIFFERENCE_S = 3e-3  # of the central differences of the tool's motion, of fourth order
SLOPE = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / 12.0
CURVATURE = np.array([-1.0, 16.0, -30.0, 16.0, -1.0]) / 12.0


@dataclass(frozen=True)
class Approach:
    """The tool's way from where it moves to rest at a target, in `duration` s."""

    coefficients: Array  # (6, 3)
    duration: float
    oriented: bool = False
    tool_axis: Array | None = None

    @staticmethod
    def of(start: tuple[Array, Array, Array], target: Array, duration: float) -> "Approach":
        """From position, velocity and acceleration (3,) of the tool to a target (3,), map_ned."""
        rest = target, np.zeros(3), np.zeros(3)
        return Approach(quintic(start, rest, duration), duration)

    def samples(self, times: Array) -> PathSamples:
        """Position, velocity and acceleration (k, 3) at `times` (k,) s; there is rest after it."""
        found = evaluate(self.coefficients, np.clip(times, 0.0, self.duration))
        return PathSamples(found.configuration, found.rate, found.acceleration, None, None, None)

    def directions(self, times: Array) -> Directions:
        """As of EndEffectorPath without a tool_axis: raises SignalError."""
        raise SignalError("an approach has no tool_axis, and so no directions for it")


class LedMotion(TimedMotion):
    """A window's plan, which rests at its end."""

    def __init__(self, plan: TimedPlan, start: int, step: float) -> None:
        super().__init__(start, step)
        self._plan = plan

    @property
    def duration(self) -> float:
        """Seconds to the target."""
        return self._plan.plan.duration

    def sample(self, times: Array) -> Samples:
        """As of TimedMotion."""
        return self._plan.plan.sample(np.clip(times, 0.0, self.duration))

    def from_stamp(self, stamp: int) -> TimedPlan:
        """The same plan with its times counted from a stamp, ns."""
        return TimedPlan(to_seconds(self.start - stamp), self._plan.plan)


def led_to(
    solver: StepSolver, knot: Knot, target: Array, step: float, before: LedMotion | None = None
) -> LedMotion:
    """The motion of the tool from a knot to rest at a target (3,) m, map_ned.

    `before` is the motion that the knot is of, from which the search begins.

    Raises GoalRejected where the target is not finite, or no motion within the limits is found.
    """
    if np.shape(target) != (3,) or not np.isfinite(target).all():
        raise GoalRejected(f"target: {target} m; it must be three finite numbers")
    start = tool_motion_at(solver, knot)
    distance = float(np.linalg.norm(target - start[0]))
    slowest = float(min(solver.motion_limits.rate[: VEHICLE - 1]))
    duration = max(SHORTEST_S, PEAK * distance / slowest)
    known = None if before is None else before.from_stamp(knot.stamp)
    for _ in range(TRIALS):
        problem = solver.path_problem(Approach.of(start, target, duration), knot)
        plan = PathWindow(problem).solve(0.0, posture_of(knot), known=known, duration=duration)
        if plan.feasible or plan.plan.report.feasible:
            return LedMotion(plan, knot.stamp, step)
        duration *= LONGER
    raise GoalRejected(
        f"target: no motion to ({target[0]:.4g}, {target[1]:.4g}, {target[2]:.4g}) m was found that"
        f" keeps the limits; {plan.plan.report.worst}"
    )


def tool_motion_at(solver: StepSolver, knot: Knot) -> tuple[Array, Array, Array]:
    """Position, velocity and acceleration (3,) of the tool at a knot, map_ned."""
    h = DIFFERENCE_S
    times = h * np.arange(-2.0, 3.0)[:, None]
    along = knot.configuration + times * knot.rate + 0.5 * times**2 * knot.acceleration
    place = tool_positions(solver.model, along)
    return place[2], SLOPE @ place / h, CURVATURE @ place / h**2
