import numpy as np
import pytest
from planner_rig import LEVEL, START, START_DEG, reference_vehicle
from pydantic import ValidationError

from uvms_core.end_effector_path import EndEffectorPath
from uvms_dynamics import build_model, end_effector, end_effector_jacobian
from uvms_planner import PathPhase, PathSpec, figure_9
from uvms_planner.constraints import free_attitude
from uvms_planner.limits import JointLimits

TOOL = np.array([1.0, 2.0, 5.0])


def test_figure_9_is_down_then_up_in_xoz_then_up_in_yoz_and_back():
    goal = figure_9().goal(TOOL, LEVEL)
    path = EndEffectorPath(goal)
    assert goal.orientations.shape == (0, 4)
    assert path.duration == figure_9().duration_s == 900.0
    assert np.array_equal(goal.positions[0], TOOL)
    assert np.allclose(goal.positions[-1], TOOL, atol=1e-15)
    down, xoz, yoz = (goal.positions[300 * k : 300 * k + 301] - TOOL for k in range(3))
    assert np.all(down[:, :2] == 0.0)
    assert np.all(np.diff(down[:, 2]) >= 0.0)
    assert np.all(xoz[:, 1] == 0.0)
    assert np.max(xoz[:, 0]) == pytest.approx(0.1, abs=1e-4)
    assert np.all(np.diff(xoz[:, 2]) <= 0.0)
    assert np.all(yoz[:, 0] == 0.0)
    assert np.max(yoz[:, 1]) == pytest.approx(0.1, abs=1e-4)
    assert np.all(np.diff(yoz[:, 2]) <= 0.0)


def test_velocity_and_acceleration_vanish_where_phases_meet():
    goal = figure_9().goal(TOOL, LEVEL)
    for index in (0, 300, 600, 900):
        near = goal.positions[max(index - 1, 0) : index + 2]
        assert np.max(np.abs(near - goal.positions[index])) < 10 * 0.35 / 300**3 * 1.2


def test_the_arm_alone_reaches_all_of_figure_9_from_a_vehicle_held_still():
    vehicle = reference_vehicle()
    model, limits = build_model(vehicle), JointLimits.of(vehicle)
    q = np.deg2rad(START_DEG)
    tool, _ = end_effector(model, START[:3], LEVEL, q)
    path = EndEffectorPath(figure_9().goal(tool, LEVEL))
    for time in np.arange(0.0, 901.0, 5.0):
        wanted = path.sample(time).position
        for _ in range(20):
            gap = wanted - end_effector(model, START[:3], LEVEL, q)[0]
            jacobian = end_effector_jacobian(model, LEVEL, q)[:3, 6:]
            q = q + np.linalg.pinv(jacobian, rcond=1e-6) @ gap
        assert np.linalg.norm(gap) < 1e-9
        # well inside: 10 degrees from every limit, far from stretched or folded
        assert np.all(q[:3] > limits.lower[:3] + np.deg2rad(10) * (limits.lower[:3] < 0))
        assert np.all(q < limits.upper - np.deg2rad(10))
        assert np.linalg.svd(jacobian, compute_uv=False)[2] > 0.2
        roll, pitch = np.rad2deg(free_attitude(model, q))
        assert abs(roll) < 5.0
        assert abs(pitch) < 4.0


def test_an_orientation_is_kept_where_that_is_wanted():
    spec = PathSpec(
        phases=(PathPhase(duration_s=3.0, to_m=(0.1, 0.0, 0.0)),), keep_orientation=True
    )
    goal = spec.goal(TOOL, LEVEL)
    assert goal.orientations.shape == (4, 4)
    assert np.all(goal.orientations == LEVEL)


def test_a_short_phase_still_has_points_inside():
    spec = PathSpec(phases=(PathPhase(duration_s=0.5, to_m=(0.01, 0.0, 0.0)),))
    assert np.array_equal(spec.goal(TOOL, LEVEL).times, [0.0, 0.25, 0.5])


@pytest.mark.parametrize(
    ("data", "where"),
    [
        ({"phases": []}, "phases"),
        ({"phases": [{"duration_s": 0.0}]}, "duration_s"),
        ({"phases": [{"to_m": [0.0, 1.0]}]}, "to_m"),
        ({"phases": [{"speed": 1.0}]}, "speed"),
        ({"point_every_s": -1.0}, "point_every_s"),
    ],
)
def test_wrong_descriptions_name_the_field(data, where):
    with pytest.raises(ValidationError, match=where):
        PathSpec.model_validate(data)
