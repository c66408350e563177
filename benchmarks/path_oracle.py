"""Whether a goal that was refused could have been followed: other starts, and steps at random."""

import numpy as np
from path_trial import Trial
from random_paths import RandomGoal

from uvms_core.rng import generator
from uvms_core.vehicle import Vehicle
from uvms_planner import GoalRejected
from uvms_planner.proposal import Proposal
from uvms_planner.whole_path import PathPlan, PathProblem
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import solve_on_knots
from uvms_planner.whole_path.pieces import coarse_breaks, fine_breaks
from uvms_planner.whole_path.search import SearchConfig, first_generation, postures_of
from uvms_planner.whole_path.solve import THOROUGH, posture_held, size_of

STARTS = 4
STEP_METHODS = ("least_norm", "sqp", "genetic_steps")
KEPT = 1.001
"""Share of a limit up to which it counts as kept."""


def possible(vehicle: Vehicle, goal: RandomGoal) -> str:
    """How the goal can be followed within every limit; empty if no way was found."""
    for method in STEP_METHODS:
        outcome = Trial(vehicle, goal, method).outcome()
        if outcome.finished and outcome.worst <= KEPT:
            return f"by {method}"
    problem = problem_of(vehicle, goal)
    return "" if problem is None else _by_starts(problem)


def problem_of(vehicle: Vehicle, goal: RandomGoal) -> PathProblem | None:
    """The whole-path problem; None where the goal is malformed."""
    trial = Trial(vehicle, goal, "genetic")
    try:
        proposal = Proposal(goal.goal, trial.planner._plan.knot, trial.solver)
    except GoalRejected:
        return None
    return trial.solver.path_problem(proposal._path, proposal._knot)


def _by_starts(problem: PathProblem) -> str:
    """The thorough schedule on the fine pieces from the posture held, and from random ones."""
    breaks = fine_breaks(coarse_breaks(problem))
    fine = discretise(problem, breaks)
    held = posture_held(fine)
    schedule = THOROUGH.scaled(size_of(fine, held))
    config = SearchConfig(population=STARTS)
    genes = first_generation(fine, generator(1, "starts"), config)
    for number, start in enumerate([held, *(postures_of(fine, each) for each in genes)]):
        found = solve_on_knots(fine, start, schedule)
        plan = PathPlan(problem, fine.knots, found.coefficients, found.iterations)
        if np.isfinite(found.cost) and plan.report.feasible:
            return f"from start {number}"
    return ""
