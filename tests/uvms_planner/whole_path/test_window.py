"""Windows of a path, planned one after the other."""

from itertools import pairwise

import numpy as np
import pytest
from planner_rig import reference_vehicle
from whole_path_rig import CIRCLE, bluerov2, problem_of

from uvms_planner.segment import tool_positions
from uvms_planner.whole_path import PathWindow, Posture, TimedPlan, solve

STEP_S = 0.5


def driven(window: PathWindow, start: Posture, until: float, whole: TimedPlan | None = None):
    """The plans of all windows, each begun where the one before is `STEP_S` later."""
    plans, last = [], None
    for begin in np.arange(0.0, until, STEP_S):
        last = window.solve(begin, start, last, whole, whole)
        plans.append(last)
        start = last.state(begin + STEP_S)
    return plans


def total(plans) -> float:
    times = np.linspace(0.0, STEP_S, 26)
    return sum(each.plan.report_at(times).disturbance for each in plans)


def test_windows_follow_the_whole_plan_at_its_cost():
    problem = problem_of(CIRCLE)
    whole = solve(problem)
    window = PathWindow(problem)
    plans = driven(window, problem.start, problem.duration, TimedPlan(0.0, whole))
    assert total(plans) < 1.1 * whole.report.disturbance
    for before, after in pairwise(plans):
        seam = np.array([after.begin])
        np.testing.assert_allclose(before.posture(seam), after.posture(seam), atol=1e-9)


def test_the_tool_is_on_its_path_in_every_window():
    problem = problem_of(CIRCLE)
    window = PathWindow(problem)
    for each in driven(window, problem.start, 5.0):
        times = np.linspace(0.0, STEP_S, 11)
        tool = tool_positions(problem.model, each.plan.sample(times).configuration)
        wanted = problem.target(each.begin + times).position
        assert np.abs(tool - wanted).max() < 1e-9


def test_without_a_whole_plan_limits_are_kept_and_it_is_better_than_a_frozen_arm():
    problem = problem_of(CIRCLE)
    window = PathWindow(problem)
    plans = driven(window, problem.start, problem.duration)
    times = np.linspace(0.0, STEP_S, 501)
    worst = max(each.plan.report_at(times).worst.share for each in plans)
    assert worst <= 1.001
    assert total(plans) < 3.0  # 15 with the arm frozen


@pytest.mark.parametrize("vehicle", [reference_vehicle, bluerov2])
def test_the_first_window_keeps_every_limit(vehicle):
    """From rest, far from the optimum, where the disturbance is greatest; sampled at 1 kHz."""
    problem = problem_of(CIRCLE, vehicle())
    window = PathWindow(problem)
    for begin in (0.0, 20.0):
        first = window.solve(begin, problem.start)
        times = np.linspace(0.0, window.duration, round(1e3 * window.duration) + 1)
        worst = first.plan.report_at(times).worst
        assert worst.share <= 1.001, worst


def test_a_window_of_a_tool_that_keeps_its_orientation_is_known_to_keep_its_limits():
    problem = problem_of({**CIRCLE, "orientation": "keep"})
    plan = solve(problem)
    assert plan.report.feasible
    whole = TimedPlan(0.0, plan)
    plans = driven(PathWindow(problem), problem.start, 3.0, whole)
    assert all(each.feasible and each.plan.report.feasible for each in plans)
