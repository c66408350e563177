"""Planner method `sqp`: each step by sequential quadratic programming."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model
from uvms_planner.choice import Choice, nearest_on_path
from uvms_planner.config import PlannerConfig
from uvms_planner.interfaces import StepMethod
from uvms_planner.problem import StepProblem
from uvms_planner.projection import project
from uvms_planner.sequential_quadratic import solve_step


class Sqp(StepMethod):
    """The step of least cost, from the previous motion or from rest; without random numbers."""

    ignores: ClassVar[Mapping[str, str]] = {
        "genetic": "the method genetic_steps; this one has sqp",
        "paper": "the method paper; this one has sqp",
        "manipulability": "methods that plan whole paths, such as genetic",
    }

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int) -> None:
        self._model = build_model(vehicle)
        self._config = config.sqp

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The increment of least cost; the nearest to the path where none is on it."""
        still = np.zeros_like(problem.previous)
        starts = np.array([problem.previous, 0.5 * problem.previous, still])
        found, increment, violation, cost, evaluations, on_path = solve_step(
            self._model, problem, starts, self._config.iterations, self._config.tolerance
        )
        if not found:
            return nearest_on_path(self._model, problem, still)
        distance, angle = project(self._model, problem, increment)
        return Choice(
            valid=True,
            increment=increment,
            distance=distance,
            angle=angle,
            attitude_violation=violation,
            cost=cost,
            evaluations=evaluations,
            feasible=on_path if violation == 0.0 else 0,
            discarded=evaluations - on_path,
        )
