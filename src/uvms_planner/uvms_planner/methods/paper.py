"""Planner method `paper`: the paper's genetic algorithm as printed, Fig. 3."""

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from uvms_core.rng import generator
from uvms_core.vehicle import Vehicle
from uvms_dynamics import Model, build_model
from uvms_planner.choice import Choice
from uvms_planner.config import PaperConfig, PlannerConfig
from uvms_planner.interfaces import StepMethod
from uvms_planner.limits import JointLimits
from uvms_planner.paper_evolution import (
    PrintedSettings,
    as_printed,
    evolve_as_printed,
    gene_lengths,
)
from uvms_planner.planar_inverse import planar_pair
from uvms_planner.problem import VEHICLE, StepProblem


class Paper(StepMethod):
    """Genes of x, y, z, psi and the joints but two; those two by inverse kinematics.

    Nothing of what `genetic` adds. Raises PlannerError for an arm without two joints that share a
    plane.
    """

    ignores: ClassVar[Mapping[str, str]] = {
        "fitness": "the other methods; this one has eq. (18) alone",
        "genetic": "the method genetic_steps; this one has paper",
        "manipulability": "methods that plan whole paths, such as genetic",
    }

    def __init__(self, vehicle: Vehicle, config: PlannerConfig, seed: int) -> None:
        self._model = build_model(vehicle)
        self._settings = printed_settings(self._model, JointLimits.of(vehicle), config.paper)
        self._seed = seed

    def choose(self, problem: StepProblem, index: int) -> Choice:
        """The fittest of all generations; not valid where all were discarded."""
        rng = generator(self._seed, f"planner step {index}")
        fitness, increment, distance, angle, violation, evaluations, feasible = evolve_as_printed(
            self._model, as_printed(problem), self._settings, rng
        )
        return Choice(
            valid=fitness > 0.0,
            increment=increment,
            distance=distance,
            angle=angle,
            attitude_violation=violation,
            cost=1.0 / fitness if fitness > 0.0 else np.inf,
            evaluations=evaluations,
            feasible=feasible,
            discarded=evaluations - feasible,
        )


def printed_settings(model: Model, joints: JointLimits, config: PaperConfig) -> PrintedSettings:
    """The configuration's numbers and the genes of this arm as the kernels take them.

    Raises PlannerError where the arm lacks the structure.
    """
    pair = planar_pair(model, joints)
    solved = (VEHICLE + pair.first, VEHICLE + pair.second)
    variables = [i for i in range(VEHICLE + len(joints.names)) if i not in solved]
    return PrintedSettings(
        population=config.population,
        generations=config.generations,
        patience=config.patience,
        crossover_rate=config.crossover_rate,
        mutation_rate=config.mutation_rate,
        first=pair.first,
        second=pair.second,
        variables=np.array(variables),
        lengths=gene_lengths(config.bits, len(variables)),
    )
