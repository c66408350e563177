import numpy as np
import pytest
from planner_rig import START, solver_of, target_near

from uvms_dynamics import coupling_wrench, restoring_wrench
from uvms_planner.fitness import body_motion, cost, judge, self_disturbance
from uvms_planner.problem import yaw_quaternion
from uvms_planner.segment import Knot, hermite

PREVIOUS = np.array([0.002, -0.001, 0.001, 0.003, 0.004, -0.005, 0.006, 0.002])
INCREMENT = np.array([0.003, -0.002, 0.002, 0.004, 0.002, -0.008, 0.009, 0.004])


def total(wrenches):
    return wrenches[:6] + wrenches[6:]


def change_of_restoring(solver):
    """Restoring wrench at the end of the step less that 4 s later."""
    level, q = yaw_quaternion(START[3] + INCREMENT[3]), START[4:] + INCREMENT[4:]
    later = q + 4.0 * INCREMENT[4:] / 0.5
    now = restoring_wrench(solver.model, level, q)
    return now - restoring_wrench(solver.model, level, later)


def problem_of(solver, previous=PREVIOUS, configuration=START):
    return solver.problem(configuration, previous, target_near(solver, configuration, [0, 0, 0]))


def test_at_rest_the_self_disturbance_is_the_restoring_wrench():
    solver = solver_of()
    still = np.zeros(8)
    wrench = total(self_disturbance(solver.model, problem_of(solver, still), still, 6.0))
    restoring = restoring_wrench(solver.model, yaw_quaternion(0.0), START[4:].copy())
    assert np.allclose(wrench, restoring, atol=1e-12)


def test_it_is_restoring_where_the_motion_leads_plus_coupling_of_the_step():
    solver = solver_of()
    problem = problem_of(solver)
    nu, nu_dot = body_motion(problem.configuration, problem.previous, INCREMENT, problem.step)
    q, q_dot = START[4:] + INCREMENT[4:], INCREMENT[4:] / 0.5
    q_ddot = (INCREMENT[4:] - PREVIOUS[4:]) / 0.25
    level = yaw_quaternion(START[3] + INCREMENT[3])
    expected = coupling_wrench(solver.model, nu, nu_dot, q, q_dot, q_ddot)
    expected = expected + restoring_wrench(solver.model, level, q + 4.0 * q_dot)
    wrench = total(self_disturbance(solver.model, problem, INCREMENT, 4.0))
    assert np.allclose(wrench, expected)
    assert np.allclose(
        solver.disturbance(problem, INCREMENT) - expected, change_of_restoring(solver)
    )


def test_the_motion_of_a_step_is_that_of_the_body():
    solver = solver_of()
    turned = START.copy()
    turned[3] = 0.7
    problem = problem_of(solver, configuration=turned)
    nu, nu_dot = body_motion(problem.configuration, problem.previous, INCREMENT, problem.step)
    rate, bend = INCREMENT / 0.5, (INCREMENT - PREVIOUS) / 0.25
    end = turned + INCREMENT
    knot = Knot(0, end, rate, bend, INCREMENT)
    samples = hermite(knot, Knot(0, end + 1e-3 * rate, rate, bend, INCREMENT), 1e-3, np.zeros(1))
    yaw = samples.configuration[0, 3]
    turn = np.array([[np.cos(yaw), np.sin(yaw)], [-np.sin(yaw), np.cos(yaw)]])
    assert np.allclose(nu[:2], turn @ rate[:2])
    slope = rate[3] * np.array([[-np.sin(yaw), np.cos(yaw)], [-np.cos(yaw), -np.sin(yaw)]])
    assert np.allclose(nu_dot[:2], turn @ bend[:2] + slope @ rate[:2])
    assert np.allclose(nu[2:], [rate[2], 0.0, 0.0, rate[3]])
    assert np.allclose(nu_dot[2:], [bend[2], 0.0, 0.0, bend[3]])


def test_without_the_additions_the_cost_is_equation_18_as_printed():
    nothing = dict.fromkeys(
        ("lookahead_s", "smoothness_weight", "vehicle_motion_weight", "joint_motion_weight"), 0.0
    )
    solver = solver_of(fitness={**nothing, "combined": True})
    problem = problem_of(solver)
    wrench = total(self_disturbance(solver.model, problem, INCREMENT, 0.0))
    assert cost(solver.model, problem, INCREMENT) == pytest.approx(np.sum(wrench**2), rel=1e-12)


def test_jerks_and_motion_cost():
    solver = solver_of()
    still = np.zeros(8)
    problem = problem_of(solver, still)
    at_rest = cost(solver.model, problem, still)
    yawing = still.copy()
    yawing[3] = problem.reach[3]
    extra = cost(solver.model, problem._replace(lookahead=0.0), yawing) - at_rest
    jerk = (problem.reach[3] / problem.jump[3]) ** 2
    assert extra >= problem.smoothness_weight * jerk + problem.motion_weights[3] - 1e-9


def test_a_candidate_off_the_path_is_not_valid():
    solver = solver_of()
    far = solver.problem(START, np.zeros(8), target_near(solver, START, [0.0, 0.0, 0.5]))
    assert judge(solver.model, far, np.zeros(8)) == (False, np.inf, np.inf)
    near = solver.problem(START, np.zeros(8), target_near(solver, START, [0.0, 0.0, 0.001]))
    valid, violation, value = judge(solver.model, near, np.zeros(8))
    assert valid
    assert violation == 0.0
    assert 0.0 < value < np.inf


def test_on_their_own_restoring_and_coupling_cannot_pay_for_each_other():
    solver = solver_of()
    problem = problem_of(solver)._replace(
        lookahead=0.0, smoothness_weight=0.0, motion_weights=np.zeros(8)
    )
    wrenches = self_disturbance(solver.model, problem, INCREMENT, 0.0)
    assert cost(solver.model, problem, INCREMENT) == pytest.approx(np.sum(wrenches**2), rel=1e-12)
