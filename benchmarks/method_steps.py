"""Single planner steps along paths, for every method the same, and how good each choice is."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from method_paths import PATHS, START, config_of

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.rng import generator
from uvms_core.signals import Array
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner.choice import Choice
from uvms_planner.config import FitnessConfig
from uvms_planner.fitness import cost
from uvms_planner.problem import StepProblem
from uvms_planner.projection import tool_pose
from uvms_planner.sequential_quadratic import solve_step
from uvms_planner.solver import StepSolver

PRINTED = FitnessConfig(
    combined=True,
    lookahead_s=0.0,
    smoothness_weight=0.0,
    vehicle_motion_weight=0.0,
    joint_motion_weight=0.0,
)
"""Eq. (18) as printed."""
OWN = FitnessConfig()
"""The cost that the planner has by default."""
STARTS = 60  # random starts from which the best known optimum of a step is sought
ON_PATH_M = 1e-6  # what counts as on the path for the best known optimum


@dataclass
class Result:
    """What a method did on all steps; a gap is the cost over that of the best known optimum - 1."""

    gaps: list[float] = field(default_factory=list)
    excess: list[float] = field(default_factory=list)  # N^2 over the best known optimum
    seconds: list[float] = field(default_factory=list)
    valid: list[bool] = field(default_factory=list)
    evaluations: list[int] = field(default_factory=list)


def states(every: int) -> list[tuple[Array, Array, object]]:
    """(configuration, increment before, target) of each `every`-th step of all paths.

    The states are those of the plan by `sqp`, which stays within the limits as long as any does.
    """
    solver = StepSolver(load_vehicle(), config_of("sqp", strict=False), 1)
    found, step = [], config_of("sqp").step_s
    for spec in PATHS.values():
        configuration, previous = START.copy(), np.zeros_like(START)
        position, rotation = tool_pose(solver.model, configuration)
        path = EndEffectorPath(spec.goal(position, matrix_to_quat(rotation)))
        for index in range(round(path.duration / step)):
            target = path.sample((index + 1) * step)
            if index % every == 0:
                found.append((configuration.copy(), previous.copy(), target))
            choice = solver.choose(solver.problem(configuration, previous, target), index)
            configuration, previous = configuration + choice.increment, choice.increment
    return found


def measured(
    methods: tuple[str, ...],
    fitness: FitnessConfig,
    steps: list,
    clock: Callable[[], float],
    **sections: dict,
) -> dict[str, Result]:
    """Every method on every step, judged by `fitness`; the methods take turns.

    `sections` are further sections of the planner's configuration.
    """
    solvers = {name: _solver(name, fitness, sections) for name in methods}
    judge = StepSolver(load_vehicle(), config_of("sqp", fitness=fitness), 1)
    results = {name: Result() for name in methods}
    for solver in solvers.values():  # loads kernels
        solver.choose(solver.problem(*steps[0]), 0)
    for index, state in enumerate(steps):
        problem, choices = judge.problem(*state), {}
        for name, solver in solvers.items():
            own = solver.problem(*state)
            began = clock()
            choices[name] = solver.choose(own, index)
            results[name].seconds.append(clock() - began)
        best = _best_known(judge, problem, index, choices)
        for name, choice in choices.items():
            _note(results[name], judge, problem, choice, best)
    return results


def _solver(name: str, fitness: FitnessConfig, sections: dict) -> StepSolver:
    """A method's solver; `paper` has eq. (18) alone and takes no other cost."""
    given = {} if name == "paper" else {"fitness": fitness}
    return StepSolver(load_vehicle(), config_of(name, **given, **sections), 1)


def _note(
    result: Result, judge: StepSolver, problem: StepProblem, choice: Choice, best: float
) -> None:
    result.valid.append(bool(choice.valid and choice.attitude_violation == 0.0))
    result.evaluations.append(choice.evaluations)
    if choice.valid and best < np.inf:
        excess = cost(judge.model, problem, choice.increment) - best
        result.excess.append(excess)
        result.gaps.append(excess / best)


def _best_known(
    judge: StepSolver, problem: StepProblem, index: int, choices: dict[str, Choice]
) -> float:
    """Least cost that any method or SQP from random starts found within the limits, on the path."""
    rng = generator(7, f"starts {index}")
    width = problem.upper - problem.lower
    random = problem.lower + rng.random((STARTS, len(width))) * width
    costs = [np.inf]
    for start in (problem.previous, *random):
        found, _, violation, value, *_ = solve_step(
            judge.model, problem, start[None, :].copy(), 60, 1e-7
        )
        if found and violation == 0.0:
            costs.append(value)
    for choice in choices.values():
        if choice.valid and choice.attitude_violation == 0.0 and choice.distance < ON_PATH_M:
            costs.append(cost(judge.model, problem, choice.increment))
    return min(costs)
