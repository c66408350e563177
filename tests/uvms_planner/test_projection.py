import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planner_rig import (
    START,
    six_joint_vehicle,
    solver_of,
    stubby_vehicle,
    target_near,
)
from scipy.spatial.transform import Rotation

from uvms_planner.knot_motion import knot_motion
from uvms_planner.projection import configuration_jacobian, project, rotation_error, tool_pose

SOLVER = solver_of()
STILL = np.zeros(8)


def problem_at(solver, offset, turn=None, configuration=START, previous=STILL):
    return solver.problem(configuration, previous, target_near(solver, configuration, offset, turn))


def tool_turned(solver, configuration, rotation_vector):
    """Quaternion of the tool in `configuration`, turned by a rotation vector in world axes."""
    _, rotation = tool_pose(solver.model, configuration)
    turned = Rotation.from_rotvec(rotation_vector) * Rotation.from_matrix(rotation)
    return turned.as_quat()


@pytest.mark.parametrize("make", [None, six_joint_vehicle, stubby_vehicle])
def test_the_jacobian_is_the_derivative_of_the_tool_pose(make):
    solver = solver_of(make() if make else None)
    rng = np.random.default_rng(3)
    for _ in range(20):
        c = rng.uniform(-1.0, 1.0, solver.size)
        jacobian = configuration_jacobian(solver.model, c)
        for i in range(solver.size):
            step = np.zeros(solver.size)
            step[i] = 1e-6
            after, before = tool_pose(solver.model, c + step), tool_pose(solver.model, c - step)
            assert np.allclose((after[0] - before[0]) / 2e-6, jacobian[:3, i], atol=1e-8)
            turn = rotation_error(after[1], before[1])
            assert np.allclose(turn / 2e-6, jacobian[3:, i], atol=1e-8)


@given(st.lists(st.floats(-2.0, 2.0), min_size=3, max_size=3))
@settings(max_examples=60, deadline=None)
def test_the_rotation_error_turns_the_actual_into_the_desired(vector):
    actual = Rotation.from_rotvec([0.3, -1.2, 0.8])
    desired = Rotation.from_rotvec(vector) * actual
    turn = rotation_error(desired.as_matrix(), actual.as_matrix())
    assert np.allclose((Rotation.from_rotvec(turn) * actual).as_matrix(), desired.as_matrix())


@given(
    share=st.lists(st.floats(0.0, 1.0), min_size=8, max_size=8),
    offset=st.lists(st.floats(-0.003, 0.003), min_size=3, max_size=3),
)
@settings(max_examples=80, deadline=None)
def test_every_increment_within_the_limits_is_brought_onto_the_path_and_stays_within(share, offset):
    problem = problem_at(SOLVER, offset)
    increment = problem.lower + np.array(share) * (problem.upper - problem.lower)
    distance, _ = project(SOLVER.model, problem, increment)
    assert np.all(increment >= problem.lower)
    assert np.all(increment <= problem.upper)
    actual = np.linalg.norm(problem.position - tool_pose(SOLVER.model, START + increment)[0])
    assert distance == pytest.approx(actual, abs=1e-9)
    if np.max(np.abs(share - np.array(0.5))) < 0.25:
        assert distance < 1e-8


def test_from_rest_it_finds_the_weighted_least_increment():
    offset = np.array([1e-6, -2e-6, 1.5e-6])
    problem = problem_at(SOLVER, offset)._replace(damping=0.0)
    increment = np.zeros(8)
    project(SOLVER.model, problem, increment)
    jacobian = configuration_jacobian(SOLVER.model, START)[:3]
    weighted = problem.readiness[:, None] * jacobian.T
    assert np.allclose(
        increment, weighted @ np.linalg.solve(jacobian @ weighted, offset), atol=1e-11
    )


def test_with_an_orientation_both_are_met():
    turn = tool_turned(SOLVER, START, [0.004, -0.003, 0.005])
    problem = problem_at(SOLVER, [0.001, 0.002, -0.001], turn)
    increment = np.zeros(8)
    distance, angle = project(SOLVER.model, problem, increment)
    assert distance < 1e-8
    assert angle < 1e-8
    position, rotation = tool_pose(SOLVER.model, START + increment)
    assert np.allclose(position, problem.position, atol=1e-8)
    assert np.allclose(rotation, problem.rotation, atol=1e-8)


def test_what_is_out_of_reach_is_approached_and_told():
    problem = problem_at(SOLVER, [0.0, 0.0, 5.0])
    increment = np.zeros(8)
    distance, _ = project(SOLVER.model, problem, increment)
    moved = tool_pose(SOLVER.model, START + increment)[0]
    assert distance == pytest.approx(np.linalg.norm(problem.position - moved))
    assert 4.9 < distance < 5.0
    assert increment[2] == problem.upper[2]


def test_a_blocked_variable_leaves_the_others_to_do_it():
    problem = problem_at(SOLVER, [0.0, 0.0, 0.001])
    problem.lower[[1, 2, 5]] = problem.upper[[1, 2, 5]] = 0.0
    increment = np.zeros(8)
    distance, _ = project(SOLVER.model, problem, increment)
    assert distance < 1e-8
    assert np.all(increment[[1, 2, 5]] == 0.0)


def test_with_the_arm_alone_the_vehicle_does_not_move():
    solver = solver_of(method="arm_only")
    problem = problem_at(solver, [0.0, 0.001, 0.002])
    increment = problem.upper.copy()
    distance, _ = project(solver.model, problem, increment)
    assert distance < 1e-8
    assert np.all(increment[:4] == 0.0)


@pytest.mark.parametrize("oriented", [False, True])
def test_a_knot_moves_as_the_path_does(oriented):
    turn = tool_turned(SOLVER, START, [0.0, 0.0, 0.0]) if oriented else None
    previous = np.array([1e-3, -1e-3, 5e-4, 2e-3, 3e-3, -2e-3, 4e-3, 1e-3])
    problem = problem_at(SOLVER, [0.001, 0.0, 0.001], turn, previous=previous)
    increment = np.zeros(8)
    project(SOLVER.model, problem, increment)
    velocity = np.array([0.01, -0.02, 0.015, 0.01, 0.02, -0.03])
    acceleration = np.array([0.03, 0.01, -0.02, 0.01, -0.02, 0.02])
    rate, bend = knot_motion(SOLVER.model, problem, increment, velocity, acceleration)
    rows = 6 if oriented else 3
    end, h = START + increment, 1e-4

    def moving(t):
        return configuration_jacobian(SOLVER.model, end + t * rate) @ (rate + t * bend)

    assert np.allclose(moving(0.0)[:rows], velocity[:rows], atol=1e-7)
    bending = (moving(h) - moving(-h)) / (2 * h)
    assert np.allclose(bending[:rows], acceleration[:rows], atol=1e-6)
