"""An axis of the tool that points where the path wants it, and turns freely about itself."""

from dataclasses import replace

import numpy as np
import pytest
from planner_rig import reference_vehicle
from scipy.spatial.transform import Rotation
from whole_path_rig import CIRCLE, LINE, bluerov2, problem_of, start_of

from uvms_core.end_effector_path import EndEffectorPath
from uvms_dynamics.kernels.rotations import matrix_to_quat
from uvms_planner import PathSpec
from uvms_planner.joined_path import JoinedPath
from uvms_planner.projection import tool_pose
from uvms_planner.whole_path import PathPlan, ToolPath, solve
from uvms_planner.whole_path.plan import plan_values
from uvms_planner.whole_path.sample import MANIPULABILITY, NO_SURROUNDINGS, TURN, Target

ACROSS = {"orientation": "axis", "tool_axis": [0, 1, 0]}
RNG = np.random.default_rng(5)
VEHICLES = pytest.mark.parametrize("vehicle", [None, bluerov2()], ids=["reference", "bluerov2"])


def rotations(plan: PathPlan, times: np.ndarray) -> np.ndarray:
    """Tool to map_ned (k, 3, 3) by the forward kinematics."""
    model = plan.problem.model
    return np.array([tool_pose(model, c)[1] for c in plan.sample(times).configuration])


def degrees_between(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    sines = np.linalg.norm(np.cross(one, other), axis=1)
    return np.rad2deg(np.arctan2(sines, np.sum(one * other, axis=1)))


def test_the_turn_of_an_axis_is_the_shortest_one_to_where_it_points():
    problem = problem_of(LINE)
    motion = np.zeros((50, 3, problem.size))
    motion[:, 0] = RNG.uniform(-1.0, 2.0, (50, problem.size))
    axis, wanted = RNG.standard_normal(3), RNG.standard_normal((50, 3))
    axis /= np.linalg.norm(axis)
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    still = np.zeros((50, 3))
    target = Target(still, still, still, np.zeros((0, 3, 3)), axis, wanted)
    turns = plan_values(problem.model, NO_SURROUNDINGS, motion, target)[:, TURN:MANIPULABILITY]
    own = []
    for each in motion[:, 0]:
        configuration = np.concatenate([np.zeros(3), each])
        own.append(tool_pose(problem.model, configuration)[1] @ axis)
    np.testing.assert_allclose(Rotation.from_rotvec(turns).apply(wanted), own, atol=1e-12)
    np.testing.assert_allclose(np.sum(turns * wanted, axis=1), 0.0, atol=1e-12)
    angles = np.rad2deg(np.linalg.norm(turns, axis=1))
    np.testing.assert_allclose(angles, degrees_between(wanted, np.array(own)), atol=1e-9)


@VEHICLES
@pytest.mark.parametrize("path", [CIRCLE, LINE], ids=["circle", "line"])
def test_the_axis_points_where_it_did_and_the_rest_is_free(vehicle, path):
    plan = solve(problem_of({**path, **ACROSS}, vehicle))
    full = solve(problem_of({**path, "keep_orientation": True}, vehicle))
    times = np.linspace(0.0, plan.duration, 2000)
    own = rotations(plan, times)
    assert plan.report.feasible, plan.report.worst
    assert degrees_between(own[:, :, 1], np.tile(own[0, :, 1], (2000, 1))).max() < 0.1
    turned = degrees_between(own[:, :, 2], np.tile(own[0, :, 2], (2000, 1))).max()
    assert turned > 5.0
    assert plan.report.disturbance < 0.95 * full.report.disturbance
    turn = next(limit for limit in plan.report.limits if limit.name == "turn of the tool")
    assert turn.share < 0.05


@VEHICLES
def test_an_axis_that_begins_elsewhere_is_joined_smoothly(vehicle):
    problem = problem_of({**LINE, **ACROSS}, vehicle)
    start = start_of(vehicle or reference_vehicle())
    position, rotation = tool_pose(problem.model, start)
    goal = PathSpec.model_validate({**LINE, **ACROSS}).goal(position, matrix_to_quat(rotation))
    off = Rotation.from_rotvec(np.deg2rad([0.0, 0.0, 12.0]))
    goal = replace(goal, axis_directions=off.apply(goal.axis_directions))
    path = JoinedPath(EndEffectorPath(goal), position, matrix_to_quat(rotation), 10.0)
    plan = solve(replace(problem, tool=ToolPath(path)))
    assert plan.report.feasible, plan.report.worst
    times = np.linspace(0.0, plan.duration, 500)
    own = rotations(plan, times)[:, :, 1]
    assert degrees_between(own, path.directions(times).direction).max() < 0.1
    late = times > 10.0
    wanted = np.tile(goal.axis_directions[0], (late.sum(), 1))
    assert degrees_between(own[late], wanted).max() < 0.1


def test_a_path_that_goes_slower_points_there_later():
    problem = problem_of({**LINE, **ACROSS})
    slower = problem.tool.slower(3.0).after(6.0)
    times = np.array([0.0, 3.0, 30.0])
    expected = problem.tool.target(2.0 + times / 3.0).direction
    np.testing.assert_allclose(slower.target(times).direction, expected, atol=1e-12)
