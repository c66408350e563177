"""A prescribed orientation that cannot be had is explained, and what is offered can be followed."""

import re

import numpy as np
import pytest
import yaml
from planner_rig import drive, reference_vehicle
from scipy.spatial.transform import Rotation
from whole_path_rig import LINE, problem_of

from uvms_core.signals import PathGoal
from uvms_core.vehicle import dump_vehicle
from uvms_core.vehicle.loader import vehicle_from_data
from uvms_planner import GoalRejected
from uvms_planner.whole_path.orientation_reach import hard_turn, orientation_gap

WRIST_DEG, ROLL_DEG, MARGIN_DEG = 20.0, 60.0, 2.0
LEVEL_DEG = (0.0, -20.0, 20.0, 0.0)
"""The tool's z axis is level, so that neither yaw nor the pitch joints roll it."""
ANY_ATTITUDE = {"roll_max_deg": 90.0, "pitch_max_deg": 90.0}


def stiff_wristed():
    """The reference vehicle with a wrist that turns by 20 degrees either way."""
    data = yaml.safe_load(dump_vehicle(reference_vehicle()))
    data["arm"]["joints"][3].update(lower_deg=-WRIST_DEG, upper_deg=WRIST_DEG)
    return vehicle_from_data(data)


def rolled(run, degrees=ROLL_DEG, seconds=20.0) -> PathGoal:
    """Where it is, rolled about the tool's z axis."""
    position, quaternion = run.planner.end_effector
    turns = Rotation.from_quat(quaternion) * Rotation.from_euler("z", [[0.0], [degrees]], True)
    return PathGoal(np.array([0.0, seconds]), np.tile(position, (2, 1)), turns.as_quat())


def pointing(run, seconds=20.0) -> PathGoal:
    """Where it is, with the tool's z axis kept."""
    position, quaternion = run.planner.end_effector
    axis = np.array([0.0, 0.0, 1.0])
    return PathGoal(
        np.array([0.0, seconds]), np.tile(position, (2, 1)), np.zeros((0, 4)), axis,
        np.tile(Rotation.from_quat(quaternion).apply(axis), (2, 1)),
    )  # fmt: skip


def test_a_roll_beyond_the_wrist_says_when_how_far_about_what_and_what_can_be_followed():
    vehicle = stiff_wristed()
    run = drive(vehicle, LEVEL_DEG, limits=ANY_ATTITUDE)
    with pytest.raises(GoalRejected) as caught:
        run.planner.accept(rolled(run))
    match = re.fullmatch(
        r"path: from t = ([\d.]+) s on its orientation is out of reach: at t = 20 s the nearest"
        r" that the limits of joints, depth, roll and pitch allow is ([\d.]+) deg away, allowed 0.5"
        r" deg, most of it about the tool's z axis; it can be followed with orientation axis,"
        r" tool_axis \[0, 0, 1\], or with orientation free",
        str(caught.value),
    )
    assert match, caught.value
    # The rotation that is left has cos(a/2) = cos(h/2) cos(p/2) C + sin(h/2) sin(p/2) S at a
    # heading h and a pitch p, with C and S of the missing roll's half: least at h = p = 0.
    assert float(match[2]) == pytest.approx(ROLL_DEG - WRIST_DEG + MARGIN_DEG, abs=0.02)
    share = (WRIST_DEG - MARGIN_DEG + 0.5) / ROLL_DEG
    u = np.linspace(0.0, 1.0, 10001)
    expected = 20.0 * np.interp(share, u**3 * (10 - 15 * u + 6 * u**2), u)
    assert expected <= float(match[1]) <= expected + 0.51
    run.planner.accept(pointing(run))
    assert run.until_finished().success


def test_the_roll_that_the_wrist_has_is_followed():
    run = drive(stiff_wristed(), LEVEL_DEG, limits=ANY_ATTITUDE)
    run.planner.accept(rolled(run, WRIST_DEG - MARGIN_DEG - 0.5))
    assert run.until_finished().success


def test_the_tolerance_of_the_orientation_is_the_one_that_is_configured():
    missing = ROLL_DEG - WRIST_DEG + MARGIN_DEG
    tolerance = {"orientation_tolerance_deg": 12.0}
    run = drive(stiff_wristed(), LEVEL_DEG, limits=ANY_ATTITUDE, projection=tolerance)
    run.planner.accept(rolled(run, ROLL_DEG - missing + 10.0))
    assert run.until_finished().success


def test_nothing_is_out_of_reach_where_the_positions_are_to_blame():
    path = {"line": {"to_m": [0.0, 0.0, -11.0], "duration_s": 200.0}}
    assert orientation_gap(problem_of({**path, "keep_orientation": True})) is None


def test_the_hardest_turn_is_that_of_two_vertical_axes_and_the_wrist():
    problem = problem_of({**LINE, "keep_orientation": True})
    tilt = problem.start.value[2] + problem.start.value[3] - np.pi / 2  # of the tool, from vertical
    gain, axis = hard_turn(problem, 0.0, problem.start.value)
    # J J^T = 2 z z^T + t t^T + 2 e e^T: z vertical, t along the tool, e across both.
    expected = np.sqrt((3 - np.sqrt(9 - 8 * np.sin(tilt) ** 2)) / 2)
    assert gain == pytest.approx(expected, abs=1e-5)
    assert abs(axis[1]) < 1e-5 or abs(axis[0]) < 1e-5  # in the plane of the arm


@pytest.mark.parametrize("method", ["genetic_steps", "least_norm"])
def test_step_methods_say_how_fast_the_tool_turns_where_it_does_not_move(method):
    run = drive(method=method)
    with pytest.raises(GoalRejected) as caught:
        run.planner.accept(rolled(run, 90.0, 1.0))
    assert "m/s" not in str(caught.value)
    assert re.search(r"it turns at [\d.]+ deg/s", str(caught.value))
