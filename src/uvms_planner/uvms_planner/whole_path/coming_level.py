"""A vehicle that floats beyond the limits of eq. (17) where a path begins comes back once."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from uvms_planner.whole_path.path_problem import PathProblem
from uvms_planner.whole_path.plan import PathPlan
from uvms_planner.whole_path.plan_report import FORGIVEN
from uvms_planner.whole_path.sample import ATTITUDE, TURN
from uvms_planner.whole_path.solve import Progress


def level_once_back(
    problem: PathProblem,
    roll_pitch: tuple[float, float],
    plan_path: Callable[[PathProblem, Progress], PathPlan],
    progress: Progress,
) -> PathPlan:
    """The plan of a problem whose limits are those of a start beyond `roll_pitch`, rad.

    It comes back within those as it likes. Where it then leaves them again, it is planned with them
    as its limits, and that plan is taken if there is one that keeps all limits.
    """
    plan = plan_path(problem, progress)
    if not plan.report.feasible or stays_level(plan, roll_pitch):
        return plan
    roll, pitch = roll_pitch
    own = replace(problem, limits=replace(problem.limits, roll_max=roll, pitch_max=pitch))
    again = plan_path(own, lambda share, text: progress(1.0, text))
    return again if again.report.feasible else plan


def stays_level(plan: PathPlan, roll_pitch: tuple[float, float]) -> bool:
    """Whether the free attitude, once within `roll_pitch`, rad, stays there."""
    tilt = np.abs(plan.values(plan.instants())[:, ATTITUDE:TURN])
    over = np.max(tilt / np.array(roll_pitch), axis=1)
    within = np.flatnonzero(over <= 1 + FORGIVEN)
    return len(within) == 0 or bool(over[within[0] :].max() <= 1 + FORGIVEN)
