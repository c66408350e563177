"""The plan over a whole path: exact, within every limit, and the best there is."""

from dataclasses import replace

import numpy as np
import pytest
from whole_path_rig import CIRCLE, LINE, bluerov2, problem_of, random_path

from uvms_core.rng import generator
from uvms_core.scene import Obstacle
from uvms_planner.segment import tool_positions
from uvms_planner.whole_path import PathPlan, Posture, slow_down, solve
from uvms_planner.whole_path.discrete import discretise
from uvms_planner.whole_path.newton import solve_on_knots
from uvms_planner.whole_path.pieces import coarse_breaks, fine_breaks
from uvms_planner.whole_path.search import SearchConfig, first_generation, postures_of
from uvms_planner.whole_path.slower import slowed
from uvms_planner.whole_path.solve import FULL, ROUGH


def frozen(problem) -> PathPlan:
    """The plan that leaves the posture as it is."""
    discrete = discretise(problem, coarse_breaks(problem))
    held = np.tile(problem.start.value, (len(discrete.grid.numbers), 1))
    return PathPlan(problem, discrete.knots, held, 0)


def each_millisecond(plan: PathPlan) -> np.ndarray:
    return np.linspace(0.0, plan.duration, round(1000 * plan.duration) + 1)


def test_the_tool_is_on_its_path_at_any_time():
    problem = problem_of(CIRCLE)
    plan = solve(problem)
    times = np.sort(np.random.default_rng(1).uniform(0.0, plan.duration, 500))
    tool = tool_positions(problem.model, plan.sample(times).configuration)
    assert np.abs(tool - problem.target(times).position).max() < 1e-9


def test_rates_and_accelerations_are_derivatives_of_the_configuration():
    plan = solve(problem_of(LINE))
    times, h = np.linspace(1.0, 39.0, 60), 1e-4
    before, here, after = (plan.sample(times + shift) for shift in (-h, 0.0, h))
    rate = (after.configuration - before.configuration) / (2 * h)
    np.testing.assert_allclose(here.rate, rate, atol=1e-6)
    np.testing.assert_allclose(here.acceleration, (after.rate - before.rate) / (2 * h), atol=1e-4)


def test_it_begins_as_given_and_ends_at_rest():
    problem = problem_of(LINE)
    rate = np.array([0.01, -0.02, 0.01, 0.0, 0.0])
    start = Posture(problem.start.value, rate, -0.1 * rate)
    plan = solve(replace(problem, start=start))
    first, last = plan.posture(np.array([0.0, plan.duration]))
    np.testing.assert_allclose(first, [start.value, start.rate, start.acceleration], atol=1e-9)
    np.testing.assert_allclose(last[1:], 0.0, atol=1e-9)


@pytest.mark.parametrize("seed", range(20))
def test_random_paths_keep_every_limit_and_never_lose_to_a_frozen_arm(seed):
    problem = problem_of(random_path(1000 + seed), bluerov2() if seed % 4 == 3 else None)
    plan = solve(problem)
    report = plan.report_at(each_millisecond(plan))
    assert report.feasible, report.worst
    still = frozen(problem).report
    assert not still.feasible or report.disturbance <= still.disturbance


@pytest.mark.parametrize("path", [LINE, random_path(3)], ids=["line", "curve"])
def test_no_start_of_many_leads_to_a_much_better_plan(path):
    problem = problem_of(path)
    coarse = discretise(problem, coarse_breaks(problem))
    fine = discretise(problem, fine_breaks(coarse_breaks(problem)))
    genes = first_generation(coarse, generator(5, "starts"), SearchConfig(population=10))
    found = min(
        (solve_on_knots(coarse, postures_of(coarse, each), ROUGH) for each in genes),
        key=lambda solution: solution.cost,
    )
    best = solve_on_knots(fine, fine.taken_from(coarse.knots, found.coefficients), FULL)
    plan = solve(problem)
    assert plan.report.disturbance <= 1.1 * fine.disturbance(best.coefficients)


def test_the_same_seed_gives_the_same_plan():
    one, other = (solve(problem_of(random_path(7)), seed=4) for _ in range(2))
    np.testing.assert_array_equal(one.coefficients, other.coefficients)


def test_the_work_grows_with_the_length_alone():
    problem = problem_of({"line": {"to_m": [1.0, 0.0, 0.0], "duration_s": 900.0}})
    short, long = (
        discretise(each, fine_breaks(coarse_breaks(each)))
        for each in (problem, slowed(problem, 4.0))
    )
    assert long.unknowns <= 4.4 * short.unknowns
    assert len(long.times) <= 4.4 * len(short.times)


def test_a_prescribed_orientation_is_kept():
    problem = problem_of({**CIRCLE, "keep_orientation": True})
    report = solve(problem).report
    assert report.feasible, report.worst
    turn = next(limit for limit in report.limits if limit.name == "turn of the tool")
    assert turn.share < 0.5


def test_a_start_beyond_the_free_attitude_comes_back():
    problem = problem_of(LINE, bluerov2())
    assert not frozen(problem).report.feasible
    assert solve(problem).report.feasible


def test_what_is_too_fast_says_which_limit_and_how_much_slower_it_goes():
    problem = slowed(problem_of(LINE), 0.2)
    report = solve(problem).report
    assert not report.feasible
    assert "acceleration of x of the vehicle" in str(report.worst)
    slower = slow_down(problem)
    assert slower.plan.report.feasible
    assert not solve(slowed(problem, slower.factor / 1.1)).report.feasible


def test_what_cannot_be_reached_at_any_speed_is_not_slowed_down():
    problem = problem_of({"line": {"to_m": [0.0, 0.0, -12.0], "duration_s": 100.0}})
    assert "z of the vehicle" in str(solve(problem).report.worst)
    slowest = slow_down(problem)
    assert not slowest.plan.report.feasible
    assert "z of the vehicle" in str(slowest.plan.report.worst)


def test_progress_only_grows():
    shares = []
    solve(problem_of(LINE), progress=lambda share, text: shares.append((share, text)))
    assert [share for share, _ in shares] == sorted(share for share, _ in shares)
    assert shares[-1][0] == 1.0


def test_it_goes_around_an_obstacle():
    path = {"line": {"to_m": [1.5, 0.0, 0.0], "duration_s": 60.0}}
    free = solve(problem_of(path))
    middle = free.sample(np.array([30.0])).configuration[0, :3] + [0.0, 0.35, 0.0]
    rock = Obstacle(name="rock", sphere={"center_m": middle.tolist(), "radius_m": 0.2})
    blocked = problem_of(path, obstacles=(rock,))
    assert not replace(free, problem=blocked).report.feasible
    assert solve(blocked).report.feasible
