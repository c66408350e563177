"""Planner method `least_norm`: the smallest motion that follows the path."""

import numpy as np

from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model
from uvms_planner.choice import Choice, nearest_on_path
from uvms_planner.config import PlannerConfig
from uvms_planner.interfaces import StepMethod
from uvms_planner.problem import StepProblem


class LeastNorm(StepMethod):
    """Weighted pseudo-inverse of eq. (12), without regard to the self-disturbance."""

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int) -> None:
        self._model = build_model(vehicle)

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The increment nearest to zero that is on the path."""
        return nearest_on_path(self._model, problem, np.zeros_like(problem.configuration))
