"""Paths of the end effector that whole-path plans are measured on."""

import numpy as np

from uvms_bringup.scenario import load_scenario
from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.rng import generator
from uvms_core.signals import Array
from uvms_dynamics.simulation.plant.config import initial_joints
from uvms_planner.problem import VEHICLE
from uvms_planner.solver import StepSolver
from uvms_planner.whole_path import PathPlan, PathProblem, Posture, ToolPath
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import Schedule, solve_on_knots
from uvms_planner.whole_path.pieces import coarse_breaks, fine_breaks
from uvms_planner.whole_path.search import SearchConfig, first_generation, postures_of
from uvms_planner.whole_path.solve import ROUGH, posture_held, size_of

EXACT = Schedule(barriers=(1e-3, 1e-4, 1e-5, 1e-6, 1e-7), steps=10, final_steps=40, tolerance=1e-6)
"""Until nothing is gained any more."""

_PAPER_60 = (
    "{phases: [{duration_s: 20, to_m: [0, 0, 0.35]},"
    " {duration_s: 20, to_m: [0, 0, 0.15], bulge_m: [0.1, 0, 0]},"
    " {duration_s: 20, to_m: [0, 0, 0], bulge_m: [0, 0.1, 0]}]}"
)
_CIRCLE = "{{circle: {{radius_m: 0.3, plane: {}, turns: 2, period_s: 60}}}}"
_LINE = "{{line: {{to_m: [{}, 0, 0], duration_s: 120}}}}"
PATHS: dict[str, tuple[str, str | None]] = {
    "paper_900": ("reference_auv", None),
    "paper_60": ("reference_auv", _PAPER_60),
    "circle_xoz": ("reference_auv", _CIRCLE.format("XOZ")),
    "circle_horizontal": ("reference_auv", _CIRCLE.format("XOY")),
    "circle_yoz": ("reference_auv", _CIRCLE.format("YOZ")),
    "line_astern": ("reference_auv", _LINE.format(-3)),
    "line_ahead": ("reference_auv", _LINE.format(3)),
    "bluerov2_circle_xoz": ("bluerov2_alpha5", _CIRCLE.format("XOZ")),
    "bluerov2_line_ahead": ("bluerov2_alpha5", _LINE.format(3)),
    "bluerov2_paper_60": ("bluerov2_alpha5", _PAPER_60),
}
"""Vehicle and `goal.path`; none: the scenario's own, the paper's Fig. 9."""


def problem_of(name: str) -> PathProblem:
    """One of `PATHS` from the scenario's start, with every limit."""
    vehicle_name, path = PATHS[name]
    changes = [f"vehicle={vehicle_name}", *([f"goal.path={path}"] if path else [])]
    scenario = load_scenario("manipulation", changes)
    vehicle, config = scenario.load_vehicle(), scenario.planner
    tool = ToolPath(EndEffectorPath(scenario.goal.build(vehicle, scenario.plant)))
    place = [*scenario.plant.initial_position_m, 0.0]
    start = np.concatenate([place, initial_joints(vehicle, scenario.plant)])
    solver = StepSolver(vehicle, config, scenario.seed)
    return PathProblem(
        solver.model, tool, tool.duration, Posture.at_rest(start[VEHICLE - 1 :]),
        solver.limits_from(start), around=solver.around_from(start),
    )  # fmt: skip


def held(problem: PathProblem) -> PathPlan:
    """The plan that leaves the posture as it is."""
    discrete = discretise(problem, coarse_breaks(problem))
    posture = np.tile(problem.start.value, (len(discrete.grid.numbers), 1))
    return PathPlan(problem, discrete.knots, posture, 0)


def least_clearance(plan: PathPlan) -> float:
    """Least distance of the pairs of arm and hull along a plan, m, up to 15 cm beyond a margin."""
    pairs = len(plan.problem.around.margins)
    return float(plan.values(plan.instants())[:, -pairs:].min())


def best_of_starts(problem: PathProblem, count: int) -> float:
    """J of the best of the optima near `count` random postures and ways between some.

    The best of the coarse pieces is solved to the end on pieces half as long as a plan's.
    """
    breaks = coarse_breaks(problem)
    coarse, halves = discretise(problem, breaks), _halved(fine_breaks(breaks))
    size = size_of(coarse, posture_held(coarse))
    genes = first_generation(coarse, generator(1, "starts"), SearchConfig(population=count))
    starts = [posture_held(coarse), *(postures_of(coarse, each) for each in genes)]
    rough = (solve_on_knots(coarse, start, ROUGH.scaled(size)) for start in starts)
    best = min(rough, key=lambda solution: solution.cost)
    fine = discretise(problem, halves)
    begin = fine.taken_from(coarse.knots, best.coefficients)
    found = solve_on_knots(fine, begin, EXACT.scaled(size))
    plan = PathPlan(problem, fine.knots, found.coefficients, found.iterations)
    return plan.report.disturbance if plan.report.feasible else np.inf


def _halved(breaks: Array) -> Array:
    """The same ends, and the middle of every piece."""
    return np.sort(np.concatenate([breaks, (breaks[1:] + breaks[:-1]) / 2]))
