import numpy as np
import pytest
from planner_rig import CALM, START, six_joint_vehicle, solver_of, stubby_vehicle, target_near
from scipy.optimize import minimize

from uvms_core.vehicle import load_vehicle
from uvms_planner.constraints import attitude_violation, free_attitude
from uvms_planner.fitness import cost
from uvms_planner.projection import tool_pose

VEHICLES = {
    "reference": None,
    "stubby": stubby_vehicle(),
    "six_joints": six_joint_vehicle(),
    "bluerov2": load_vehicle("bluerov2_alpha5"),
}


def random_step(solver, rng, oriented=False):
    """A step from a random posture and motion to a target that random increments reach."""
    n = len(solver.joints.names)
    low, high = solver.limits.lower[4:], solver.limits.upper[4:]
    configuration = np.concatenate(
        [[0.0, 0.0, 10.0, rng.normal()], low + (0.2 + 0.6 * rng.random(n)) * (high - low)]
    )
    previous = 0.4 * (2.0 * rng.random(4 + n) - 1.0) * solver.limits.reach
    lower, upper = solver.limits.increments(configuration, previous)
    increment = lower + (0.3 + 0.4 * rng.random(4 + n)) * (upper - lower)
    offset = (
        tool_pose(solver.model, configuration + increment)[0]
        - tool_pose(solver.model, configuration)[0]
    )
    return solver.problem(configuration, previous, target_near(solver, configuration, offset))


def slsqp(solver, problem, start):
    """Cost at scipy's minimizer from `start`, in per-step ranges; inf where it finds none."""
    reach = problem.reach

    def gap(x):
        return 1e3 * (
            problem.position - tool_pose(solver.model, problem.configuration + x * reach)[0]
        )

    def room(x):
        roll, pitch = free_attitude(solver.model, (problem.configuration + x * reach)[4:].copy())
        return 1e3 * np.array([problem.roll_max - abs(roll), problem.pitch_max - abs(pitch)])

    found = minimize(
        lambda x: cost(solver.model, problem, x * reach),
        start / reach,
        method="SLSQP",
        bounds=list(zip(problem.lower / reach, problem.upper / reach, strict=True)),
        constraints=[{"type": "eq", "fun": gap}, {"type": "ineq", "fun": room}],
        options={"maxiter": 300, "ftol": 1e-12},
    )
    kept = np.max(np.abs(gap(found.x))) < 1e-3 and np.min(room(found.x)) > -1e-6  # mm, mrad
    return found.fun if kept else np.inf


@pytest.mark.parametrize("name", VEHICLES)
def test_no_step_costs_more_than_scipys(name):
    solver, rng = solver_of(VEHICLES[name], method="sqp"), np.random.default_rng(3)
    compared = 0
    for index in range(12):
        problem = random_step(solver, rng)
        if attitude_violation(solver.model, problem, problem.configuration[4:]) > 0.0:
            problem = problem._replace(roll_max=np.pi, pitch_max=np.pi)
        choice = solver.choose(problem, index)
        assert choice.valid
        assert choice.distance < 1e-7
        assert np.all(choice.increment >= problem.lower)
        assert np.all(choice.increment <= problem.upper)
        assert choice.attitude_violation == 0.0
        assert choice.cost == pytest.approx(cost(solver.model, problem, choice.increment), rel=1e-9)
        other = slsqp(solver, problem, choice.increment)
        other = min(other, slsqp(solver, problem, problem.previous))
        assert choice.cost <= other * (1.0 + 1e-5) + 1e-9
        compared += other < np.inf
    assert compared >= 9


def test_a_limit_of_the_attitude_that_binds_is_kept_at_the_least_cost():
    solver, rng, bound = solver_of(method="sqp"), np.random.default_rng(5), 0
    for index in range(40):
        problem = random_step(solver, rng)._replace(roll_max=np.pi, pitch_max=np.pi)
        free = solver.choose(problem, index)
        before = abs(free_attitude(solver.model, problem.configuration[4:].copy())[0])
        end = (problem.configuration + free.increment)[4:]
        after = abs(free_attitude(solver.model, end.copy())[0])
        if after < before + 1e-5:
            continue
        problem = problem._replace(roll_max=0.5 * (before + after))
        choice = solver.choose(problem, index)
        if choice.attitude_violation > 0.0:
            assert slsqp(solver, problem, choice.increment) == np.inf  # nobody can
            continue
        end = (problem.configuration + choice.increment)[4:]
        assert abs(free_attitude(solver.model, end.copy())[0]) <= problem.roll_max
        assert choice.cost >= free.cost - 1e-9
        other = slsqp(solver, problem, choice.increment)
        assert choice.cost <= other * (1.0 + 1e-5) + 1e-9
        bound += 1
    assert bound >= 4


def test_from_beyond_a_limit_it_comes_back_as_fast_as_it_can():
    """Against scipy's least roll on the path; the cost comes after the limit."""
    solver, rng = solver_of(method="sqp"), np.random.default_rng(8)
    compared = 0
    for index in range(8):
        problem = random_step(solver, rng)
        start = abs(free_attitude(solver.model, problem.configuration[4:].copy())[0])
        problem = problem._replace(roll_max=0.5 * start, pitch_max=np.pi)
        choice = solver.choose(problem, index)
        reach = problem.reach

        def roll(x, problem=problem):
            q = (problem.configuration + x * problem.reach)[4:].copy()
            return abs(free_attitude(solver.model, q)[0])

        def gap(x, problem=problem):
            end = problem.configuration + x * problem.reach
            return 1e3 * (problem.position - tool_pose(solver.model, end)[0])

        least = minimize(
            lambda x: 1e3 * roll(x),
            choice.increment / reach,
            method="SLSQP",
            bounds=list(zip(problem.lower / reach, problem.upper / reach, strict=True)),
            constraints=[{"type": "eq", "fun": gap}],
            options={"maxiter": 300, "ftol": 1e-12},
        )
        if np.max(np.abs(gap(least.x))) > 1e-3:
            continue
        expected = max(1e-3 * least.fun - problem.roll_max, 0.0)
        assert choice.attitude_violation <= expected + 1e-5
        compared += 1
    assert compared >= 4


def test_a_step_without_freedom_is_the_one_that_there_is():
    solver = solver_of(method="sqp")
    problem = solver.problem(START, np.zeros(8), target_near(solver, START, [1e-3, 0.0, 2e-3]))
    only_vehicle = problem.lower.copy(), problem.upper.copy()
    for bound in only_vehicle:
        bound[3:] = 0.0
    problem = problem._replace(lower=only_vehicle[0], upper=only_vehicle[1])
    choice = solver.choose(problem, 0)
    assert choice.valid
    assert choice.increment == pytest.approx([1e-3, 0.0, 2e-3, 0.0, 0.0, 0.0, 0.0, 0.0], abs=1e-8)


def test_what_is_out_of_reach_is_not_valid():
    solver = solver_of(method="sqp", limits=CALM)
    problem = solver.problem(START, np.zeros(8), target_near(solver, START, [0.0, 0.0, 0.5]))
    choice = solver.choose(problem, 0)
    assert not choice.valid
    assert choice.distance == pytest.approx(0.4, abs=0.1)


def test_no_random_number_is_in_it():
    increments = []
    for seed, index in ((1, 0), (1, 5), (2, 9)):
        solver = solver_of(seed=seed, method="sqp")
        problem = random_step(solver, np.random.default_rng(1))
        increments.append(solver.choose(problem, index).increment)
    assert np.array_equal(increments[0], increments[1])
    assert np.array_equal(increments[0], increments[2])
