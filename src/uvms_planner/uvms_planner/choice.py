"""What a planner method chose for one step, and how good it is."""

from dataclasses import dataclass

from uvms_core.signals import Array
from uvms_dynamics import Model
from uvms_planner.exceeded import LimitExceeded
from uvms_planner.fitness import judge
from uvms_planner.problem import StepProblem
from uvms_planner.projection import project


@dataclass(frozen=True)
class Choice:
    """An increment of the configuration with its errors, its cost and the effort of finding it."""

    valid: bool  # whether the end effector is within e of the path
    increment: Array  # (m,)
    distance: float  # m, of the end effector from the path
    angle: float  # rad, the same for the orientation; 0 without one
    attitude_violation: float  # rad beyond the limits of eq. (17)
    cost: float  # 1 / fitness, eq. (18) with the motion's costs
    evaluations: int
    feasible: int  # candidates within e and the attitude limits
    discarded: int  # candidates not within e
    limits_exceeded: tuple[LimitExceeded, ...] = ()  # what it takes beyond the planned limits


def nearest_on_path(model: Model, problem: StepProblem, increment: Array) -> Choice:
    """The increment on the path that is nearest to `increment` (m,), judged.

    Nearest in the norm that the problem's `readiness` weights; from an increment of zero that is
    the weighted least-norm solution, eq. (12). Where the path is out of reach the choice is not
    valid and ends as near to it as the bounds allow.
    """
    moved = increment.copy()
    valid, violation, cost = judge(model, problem, moved)
    distance, angle = project(model, problem, moved)
    feasible = int(valid and violation == 0.0)
    return Choice(valid, moved, distance, angle, violation, cost, 1, feasible, int(not valid))
