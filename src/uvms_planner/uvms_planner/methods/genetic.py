"""Planner methods `genetic` and `genetic_steps`: the paper's search for the least disturbance."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from uvms_core.rng import generator
from uvms_core.vehicle import Vehicle
from uvms_dynamics import build_model
from uvms_planner.choice import Choice, nearest_on_path
from uvms_planner.config import GeneticConfig, PlannerConfig
from uvms_planner.evolution import EvolutionSettings, evolve
from uvms_planner.interfaces import StepMethod
from uvms_planner.problem import StepProblem
from uvms_planner.projection import project
from uvms_planner.whole_path import PathPlan, PathProblem, solve
from uvms_planner.whole_path.solve import Progress


class GeneticSteps(StepMethod):
    """Genetic algorithm on the increments, with the previous motion among its first individuals.

    Fig. 3, step by step; what is added to it is in docs/paper-planner.md.
    """

    ignores: ClassVar[Mapping[str, str]] = {
        "manipulability": "methods that plan whole paths, such as genetic"
    }

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int) -> None:
        self._model = build_model(vehicle)
        self._settings = settings(config.genetic)
        self._seed = seed

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The fittest increment; the nearest to the path where no individual is on it."""
        previous = problem.previous
        seeds = np.array([previous, np.zeros_like(previous), 0.5 * previous])
        rng = generator(self._seed, f"planner step {index}")
        found, increment, violation, cost, discarded, feasible, evaluations = evolve(
            self._model, problem, self._settings, seeds, rng
        )
        if not found:
            return nearest_on_path(self._model, problem, np.zeros_like(previous))
        distance, angle = project(self._model, problem, increment)
        return Choice(
            found, increment, distance, angle, violation, cost, evaluations, feasible, discarded
        )


class Genetic(GeneticSteps):
    """The whole path is planned before it begins: the genes are postures along all of it."""

    ignores: ClassVar[Mapping[str, str]] = {
        "fitness": "methods that plan step by step, such as genetic_steps",
        "genetic": "the method genetic_steps",
    }

    def plan_path(self, problem: PathProblem, progress: Progress) -> PathPlan:
        """The best plan over a whole path: a search for the basin, a solver for its bottom."""
        return solve(problem, self._seed, progress)


def settings(config: GeneticConfig) -> EvolutionSettings:
    """The configuration's numbers as the kernels take them."""
    return EvolutionSettings(
        population=config.population,
        generations=config.generations,
        bits=config.bits_per_variable,
        crossover_rate=config.crossover_rate,
        mutation_rate=config.mutation_rate,
        elite=config.elite,
        seed_refinements=config.seed_refinements,
        refinements=config.refinements,
    )
