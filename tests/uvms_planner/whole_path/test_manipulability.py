"""Yoshikawa's measure in closed form, the arm's best, and what it does to a plan."""

from dataclasses import replace

import numpy as np
import pytest
from whole_path_rig import CIRCLE, LINE, bluerov2, problem_of

from uvms_dynamics import end_effector_jacobian
from uvms_planner.problem import VEHICLE
from uvms_planner.whole_path import CostWeights, solve
from uvms_planner.whole_path.manipulability import best_manipulability, manipulability
from uvms_planner.whole_path.sample import MANIPULABILITY

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
RNG = np.random.default_rng(5)
VEHICLES = pytest.mark.parametrize("vehicle", [None, bluerov2()], ids=["reference", "bluerov2"])


def joint_bounds(problem):
    return problem.limits.lower[VEHICLE:], problem.limits.upper[VEHICLE:]


@VEHICLES
def test_it_is_the_product_of_the_singular_values(vehicle):
    problem = problem_of(LINE, vehicle)
    postures = RNG.uniform(*joint_bounds(problem), (40, problem.size - 1))
    jacobians = [end_effector_jacobian(problem.model, LEVEL, q)[:3, 6:] for q in postures]
    expected = [np.prod(np.linalg.svd(jacobian, compute_uv=False)) for jacobian in jacobians]
    np.testing.assert_allclose(manipulability(problem.model, postures), expected, atol=1e-12)


def test_of_the_reference_arm_it_is_the_lever_about_the_swing_times_the_elbow():
    problem = problem_of(LINE)
    shoulder, elbow = np.meshgrid(np.deg2rad([0, 10, 40, 70]), np.deg2rad([5, 60, 115]))
    q = np.stack([np.zeros(12), shoulder.ravel(), elbow.ravel(), np.zeros(12)], axis=1)
    links, forearm = 0.46, 0.38 + 0.18
    radius = 0.08 + links * np.cos(q[:, 1]) + forearm * np.cos(q[:, 1] + q[:, 2])
    expected = np.abs(radius * links * forearm * np.sin(q[:, 2]))
    np.testing.assert_allclose(manipulability(problem.model, q), expected, atol=1e-12)


@VEHICLES
def test_no_posture_of_many_has_more_than_the_best(vehicle):
    problem = problem_of(LINE, vehicle)
    found = manipulability(problem.model, RNG.uniform(*joint_bounds(problem), (20000, 4))).max()
    best = best_manipulability(problem.model, *joint_bounds(problem))
    assert found <= 1.001 * best
    assert found > 0.97 * best


def test_a_straight_elbow_is_singular():
    problem = problem_of(LINE)
    assert manipulability(problem.model, np.deg2rad([[0.0, 30.0, 0.0, 0.0]]))[0] < 1e-12


def test_a_plan_keeps_away_from_singular_postures_where_that_costs_next_to_nothing():
    problem = problem_of(CIRCLE, bluerov2())
    careless = solve(replace(problem, weights=CostWeights(singular=0.0))).report
    careful = solve(problem).report
    assert careful.mean_manipulability > careless.mean_manipulability
    assert careful.disturbance < 1.01 * careless.disturbance


def test_the_report_has_the_least_share_of_the_best():
    problem = problem_of(LINE)
    plan = solve(problem)
    times = plan.instants()
    q = plan.posture(times)[:, 0, 1:]
    shares = manipulability(problem.model, np.ascontiguousarray(q)) / problem.best_manipulability
    assert plan.report.manipulability == pytest.approx(shares.min(), rel=1e-9)
    assert plan.values(times)[:, MANIPULABILITY] == pytest.approx(
        shares * problem.best_manipulability, rel=1e-9
    )
