"""The words of `goal.path`: their geometry, their timing, and what is refused."""

import csv

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy.integrate import quad
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import PathGoal
from uvms_planner import PathSpec
from uvms_planner.paths.timing import eased

TOOL = np.array([1.0, 2.0, 5.0])
TURNED = Rotation.from_euler("ZYX", [40.0, 20.0, -10.0], degrees=True)
UNIT = st.floats(-1.0, 1.0)
AXES = {"XOZ": (0, 2), "YOZ": (1, 2), "XOY": (0, 1)}


def goal_of(word, **more):
    return PathSpec.model_validate({**word, **more}).goal(TOOL, TURNED.as_quat())


def offsets_of(word, **more):
    goal = goal_of(word, **more)
    return goal.times, goal.positions - TOOL


def derivatives(times, values):
    """Velocity and acceleration in the middle of equal intervals, by differences."""
    h = times[1] - times[0]
    return np.diff(values, axis=0) / h, np.diff(values, 2, axis=0) / h**2


def assert_from_rest_to_rest(times, offsets):
    """Speed and acceleration vanish at both ends like t^3 and t^2, and not only at one sample."""
    velocity, acceleration = derivatives(times, offsets)
    fastest, hardest = (np.linalg.norm(x, axis=1).max() for x in (velocity, acceleration))
    for end in (0, -1):
        assert np.linalg.norm(velocity[end]) < 2e-4 * fastest
        assert np.linalg.norm(acceleration[end]) < 2e-2 * hardest


def test_the_share_of_the_way_is_the_integral_of_the_speed():
    duration, ease = 30.0, 7.0

    def speed(t):
        u = min(t, duration - t) / ease
        return (u**3 * (10 - 15 * u + 6 * u**2) if u < 1 else 1.0) / (duration - ease)

    for t in (0.0, 3.0, 7.0, 12.0, 15.0, 16.0, 23.0, 25.0, 29.9, 30.0):
        way = quad(speed, 0.0, t, points=[min(t, 7.0), min(t, 23.0)], epsabs=1e-12)[0]
        assert eased(np.array([t]), duration, ease)[0] == pytest.approx(way, abs=1e-9)


def test_a_line_is_straight_and_takes_its_time():
    to = np.array([0.3, -0.4, 1.2])
    times, offsets = offsets_of(
        {"line": {"to_m": to.tolist(), "duration_s": 40.0}}, point_every_s=0.05
    )
    assert (times[0], times[-1]) == (0.0, 40.0)
    assert np.allclose(offsets[-1], to, atol=1e-15)
    along = offsets @ to / (to @ to)
    assert np.abs(offsets - along[:, None] * to).max() < 1e-12
    assert np.all(np.diff(along) >= 0.0)
    assert_from_rest_to_rest(times, offsets)
    speed = np.linalg.norm(derivatives(times, offsets)[0], axis=1)
    assert speed.max() == pytest.approx(1.3 / 30.0, rel=1e-6)  # 4/3 of the mean
    assert np.allclose(speed[len(speed) // 3 : -len(speed) // 3], speed.max(), rtol=1e-6)


@pytest.mark.parametrize("plane", AXES)
def test_a_circle_is_a_circle_whatever_its_speed(plane):
    first, second = AXES[plane]
    times, offsets = offsets_of(
        {"circle": {"radius_m": 0.3, "plane": plane, "turns": 2.0, "period_s": 60.0}},
        point_every_s=0.05,
    )
    centre = 0.3 * np.eye(3)[first]
    assert times[-1] == 120.0
    assert np.abs(np.linalg.norm(offsets - centre, axis=1) - 0.3).max() < 1e-15
    assert np.all(offsets[:, 3 - first - second] == 0.0)
    assert np.array_equal(offsets[0], np.zeros(3))
    assert np.abs(offsets[-1]).max() < 1e-15
    assert_from_rest_to_rest(times, offsets)
    about = offsets - centre
    angle = np.unwrap(np.arctan2(about[:, second], about[:, first]))
    assert angle[-1] - angle[0] == pytest.approx(4 * np.pi)  # from the first axis to the second
    speed = np.linalg.norm(derivatives(times, offsets)[0], axis=1).max()
    assert speed == pytest.approx(2 * np.pi * 0.3 * 2 / 90.0, rel=1e-4)


def test_the_planner_follows_the_circle_within_hundredths_of_a_millimetre():
    goal = goal_of({"circle": {"radius_m": 0.3, "plane": "XOZ", "turns": 2.0, "period_s": 60.0}})
    path = EndEffectorPath(goal)
    between = path.positions(np.linspace(0.0, 120.0, 7001)) - TOOL - [0.3, 0.0, 0.0]
    assert np.abs(np.linalg.norm(between, axis=1) - 0.3).max() < 2e-5


@settings(max_examples=40, deadline=None)
@given(st.tuples(UNIT, UNIT, UNIT), st.floats(0.01, 5.0), st.floats(-3.0, 3.0), UNIT)
def test_any_helix_keeps_its_distance_from_its_axis(normal, radius, turns, advance):
    if np.linalg.norm(normal) < 1e-2 or abs(turns) < 1e-2:
        return
    word = {"normal": normal, "radius_m": radius, "turns": turns, "duration_s": 30.0}
    _, offsets = offsets_of({"helix": {**word, "advance_m": advance}})
    axis = np.array(normal) / np.linalg.norm(normal)
    along = offsets @ axis
    flat = offsets - along[:, None] * axis
    assert along[-1] == pytest.approx(advance * abs(turns), abs=1e-9)
    if abs(turns) >= 1.0:
        # Three points give the centre; the others are as far from it.
        a, b = flat[len(flat) // 3], flat[len(flat) // 2]
        rows = np.array([a, b, axis])
        if np.linalg.cond(rows) < 1e6:
            centre = np.linalg.solve(rows, [a @ a / 2, b @ b / 2, 0.0])
            assert np.allclose(np.linalg.norm(flat - centre, axis=1), radius, rtol=1e-6)
    circle = offsets_of({"circle": word})[1]
    assert np.allclose(flat, circle, atol=1e-12 * max(1.0, radius))


def test_a_circle_about_a_normal_goes_round_it_as_a_screw_does_from_where_it_is_told():
    _, offsets = offsets_of(
        {
            "circle": {
                "radius_m": 0.2,
                "normal": [0, 0, 2],
                "towards": [0, -1, 5],
                "turns": 0.25,
                "duration_s": 10.0,
            }
        }
    )
    # The centre is 0.2 m west; from there the start is east, and a quarter turn on is south.
    assert np.allclose(offsets[-1], [-0.2, -0.2, 0.0], atol=1e-15)
    assert np.all(offsets[1:, 0] < 0.0)


POINTS = st.lists(st.tuples(UNIT, UNIT, UNIT), min_size=1, max_size=8)


@settings(max_examples=60, deadline=None)
@given(POINTS, st.lists(st.floats(1.0, 8.0), min_size=8, max_size=8), st.booleans())
def test_waypoints_are_passed_at_their_times(points, steps, stop):
    times_s = np.cumsum(steps[: len(points)])
    times, offsets = offsets_of(
        {"waypoints": {"points_m": points, "times_s": times_s.tolist(), "stop": stop}}
    )
    assert np.array_equal(offsets[0], np.zeros(3))
    for time, point in zip(times_s, points, strict=True):
        index = int(np.searchsorted(times, time))
        assert times[index] == time
        assert np.allclose(offsets[index], point, atol=1e-15)
    assert np.diff(times).max() <= 0.25 + 1e-9


@pytest.mark.parametrize("stop", [False, True])
def test_waypoints_begin_and_end_at_rest_and_have_no_jump_of_acceleration(stop):
    word = {
        "points_m": [[0.1, 0, 0], [0.1, 0.2, 0], [0, 0.2, 0.1]],
        "times_s": [10.0, 20.0, 40.0],
        "stop": stop,
    }
    times, offsets = offsets_of({"waypoints": word}, point_every_s=0.02)
    assert_from_rest_to_rest(times, offsets)
    velocity, acceleration = derivatives(times, offsets)
    steps = np.linalg.norm(np.diff(acceleration, axis=0), axis=1)
    assert steps.max() < 0.03 * np.linalg.norm(acceleration, axis=1).max()
    at = int(np.searchsorted(times, 10.0))
    moving = np.linalg.norm(velocity[at - 1 : at + 1], axis=1).max()
    assert moving < 1e-6 if stop else moving > 5e-3
    if stop:
        assert np.all(offsets[: at + 1, 1:] == 0.0)


def test_mean_speeds_give_the_times():
    points = [[0.3, 0.0, 0.4], [0.3, 1.0, 0.4]]
    spec = PathSpec.model_validate({"waypoints": {"points_m": points, "speeds_m_s": [0.05, 0.1]}})
    assert spec.duration_s == pytest.approx(10.0 + 10.0)
    spec = PathSpec.model_validate({"waypoints": {"points_m": points, "speeds_m_s": 0.05}})
    assert spec.duration_s == pytest.approx(30.0)


def test_waypoints_turn_the_tool_from_its_orientation_at_the_start():
    rpy = [[0.0, 0.0, 30.0], [10.0, -5.0, 30.0]]
    goal = goal_of(
        {
            "waypoints": {
                "points_m": [[0.1, 0, 0], [0.2, 0, 0]],
                "times_s": [10.0, 20.0],
                "rpy_deg": rpy,
            }
        },
        point_every_s=0.05,
    )
    turns = TURNED.inv() * Rotation.from_quat(goal.orientations)
    for time, angles in zip((0.0, 10.0, 20.0), ([0.0, 0.0, 0.0], *rpy), strict=True):
        found = turns[int(np.searchsorted(goal.times, time))].as_euler("ZYX", degrees=True)
        assert np.allclose(found[::-1], angles, atol=1e-9)
    rates = (turns[1:] * turns[:-1].inv()).magnitude() / 0.05
    assert rates[0] < 1e-3 * rates.max()
    assert rates[-1] < 1e-3 * rates.max()
    # no faster than from rest to rest on each way, and never as fast again as the mean
    assert np.deg2rad(3.0) < rates.max() <= 1.875 * np.deg2rad(3.0)


def table(path, rows, header=("t", "x", "y", "z")):
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(header)
        writer.writerows(rows)
    return str(path)


def test_a_table_comes_back_as_it_was_written(tmp_path):
    rng = np.random.default_rng(5)
    times = np.concatenate([[0.0], np.cumsum(rng.uniform(0.1, 3.0, 50))])
    offsets = np.vstack([np.zeros(3), rng.normal(0.0, 0.2, (50, 3))])
    turns = Rotation.random(51, random_state=2).as_quat()
    rows = np.column_stack([times, offsets, turns])
    header = ("t", "x", "y", "z", "qx", "qy", "qz", "qw")
    goal = goal_of({"csv": table(tmp_path / "path.csv", rows, header)})
    at = np.searchsorted(goal.times, times)
    assert np.array_equal(goal.times[at], times)
    assert np.array_equal(goal.positions[at], TOOL + offsets)
    same = (TURNED * Rotation.from_quat(turns)).inv() * Rotation.from_quat(goal.orientations[at])
    assert same.magnitude().max() < 1e-12
    assert np.diff(goal.times).max() <= 0.25 + 1e-9


def test_the_columns_of_a_table_may_stand_in_any_order(tmp_path):
    rows = [[0.0, 0.0, 0.0, 0.0], [0.3, 0.2, 0.1, 5.0]]
    spec = PathSpec.model_validate(
        {"csv": {"file": table(tmp_path / "p.csv", rows, ("z", "y", "x", "t"))}}
    )
    assert spec.duration_s == 5.0
    assert np.allclose(spec.points().offsets[-1], [0.1, 0.2, 0.3])


def test_a_table_of_a_circle_is_a_circle_in_between(tmp_path):
    word = {"circle": {"radius_m": 0.3, "plane": "YOZ", "duration_s": 60.0}}
    times, offsets = offsets_of(word, point_every_s=1.0)
    file = table(tmp_path / "c.csv", np.column_stack([times, offsets]))
    _, dense = offsets_of({"csv": file}, point_every_s=0.1)
    assert len(dense) == 601
    assert np.abs(np.linalg.norm(dense - [0.0, 0.3, 0.0], axis=1) - 0.3).max() < 5e-6


def every_word(tmp_path):
    file = table(tmp_path / "a.csv", [[0, 0, 0, 0], [4, 0.1, 0.2, 0.3], [9, 0, 0, 0.1]])
    points = [[0.1, 0.0, 0.2], [0.0, 0.3, 0.1]]
    return [
        {"phases": [{"duration_s": 5.0, "to_m": [0, 0, 0.3], "bulge_m": [0.1, 0, 0]}]},
        {"line": {"to_m": [0.1, 0.2, 0.3], "duration_s": 12.0}},
        {"circle": {"radius_m": 0.2, "normal": [1, 1, 0], "duration_s": 20.0}},
        {"helix": {"radius_m": 0.2, "plane": "XOY", "advance_m": 0.1, "period_s": 20.0}},
        {"waypoints": {"points_m": points, "speeds_m_s": 0.05}},
        {"waypoints": {"points_m": points, "times_s": [3.0, 9.0], "stop": True}},
        {"csv": file},
    ]


def test_a_scaled_path_has_other_lengths_and_the_same_times(tmp_path):
    for word in every_word(tmp_path):
        spec = PathSpec.model_validate(word)
        own, other = spec.points(), spec.scaled(1.7).points()
        assert np.allclose(own.times, other.times, rtol=1e-14), word
        assert np.allclose(1.7 * own.offsets, other.offsets, atol=1e-14), word
        assert np.abs(own.offsets).max() > 0.05


def test_every_word_is_read_back_as_it_is_written(tmp_path):
    for word in every_word(tmp_path):
        spec = PathSpec.model_validate(word)
        assert PathSpec.model_validate(spec.model_dump(mode="json")) == spec


def test_the_orientation_of_the_start_is_kept_with_any_word_that_has_none(tmp_path):
    for word in every_word(tmp_path):
        goal = goal_of(word, keep_orientation=True)
        assert np.array_equal(goal.orientations, np.tile(TURNED.as_quat(), (len(goal.times), 1)))


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({}, ["one of phases, line, circle, helix, waypoints, csv", "none"]),
        ({"line": {"to_m": [0, 0, 1], "duration_s": 1}, "phases": [{}]}, ["phases and line"]),
        ({"line": {"to_m": [0, 0, 1], "duration_s": 10, "ease_s": 6}}, ["6 s", "at most 5 s"]),
        ({"line": {"to_m": [0, 0, 2e3], "duration_s": 10}}, ["line.to_m.2", "1000"]),
        ({"circle": {"radius_m": 0, "plane": "XOY", "duration_s": 9}}, ["radius_m"]),
        ({"circle": {"radius_m": 1, "plane": "XY", "duration_s": 9}}, ["'XOZ', 'YOZ' or 'XOY'"]),
        ({"circle": {"radius_m": 1, "duration_s": 9}}, ["plane or normal", "neither"]),
        ({"circle": {"radius_m": 1, "plane": "XOY"}}, ["period_s or duration_s", "neither"]),
        (
            {"circle": {"radius_m": 1, "plane": "XOY", "turns": 0, "duration_s": 9}},
            ["turns", "not be 0"],
        ),
        (
            {"circle": {"radius_m": 1, "plane": "XOY", "turns": 999, "period_s": 999}},
            ["998001 s", "86400 s"],
        ),
        (
            {"circle": {"radius_m": 1, "plane": "XOY", "towards": [0, 0, 1], "duration_s": 9}},
            ["towards", "[0, 0, 1]", "no part in the plane"],
        ),
        ({"circle": {"radius_m": 1, "normal": [0, 0, 0], "duration_s": 9}}, ["normal", "zero"]),
        ({"waypoints": {"points_m": [[0, 0, 1]]}}, ["times_s or speeds_m_s", "neither"]),
        (
            {"waypoints": {"points_m": [[0, 0, 1]], "times_s": [1, 2]}},
            ["times_s", "2 values for 1"],
        ),
        (
            {"waypoints": {"points_m": [[0, 0, 1], [0, 0, 2]], "times_s": [2, 1]}},
            ["increasing", "[2, 1]"],
        ),
        ({"waypoints": {"points_m": [[0, 0, 0]], "speeds_m_s": 0.1}}, ["points_m.0", "times_s"]),
        ({"csv": "nowhere.csv"}, ["nowhere.csv", "no file"]),
        (
            {
                "waypoints": {"points_m": [[0, 0, 1]], "times_s": [1], "rpy_deg": [[0, 0, 5]]},
                "keep_orientation": True,
            },
            ["keep_orientation", "waypoints"],
        ),
    ],
)
def test_what_is_no_path_is_refused_with_the_reason(data, words):
    with pytest.raises(ValidationError) as fault:
        PathSpec.model_validate(data)
    assert all(word in str(fault.value) for word in words), fault.value


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["header line is ''", "t,x,y,z"]),
        ("0,0,0,0\n1,0,0,1\n", ["header line is '0,0,0,0'"]),
        ("t,x,y,z\n0,0,0,0\n", ["two rows", "has 1"]),
        ("t,x,y,z\n0,0,0,0\n1,0,0\n", ["line 3", "3 values", "has 4"]),
        ("t,x,y,z\n0,0,0,0\n1,0,0,one\n", ["line 3", "'one'"]),
        ("t,x,y,z\n1,0,0,0\n2,0,0,1\n", ["first time is 1 s"]),
        ("t,x,y,z\n0,0,0,0\n2,0,0,1\n2,0,0,2\n", ["2 s after 2 s"]),
        ("t,x,y,z\n0,0,0,0\nnan,0,0,1\n", ["nan s after 0 s"]),
        ("t,x,y,z\n0,0,0,0\n2,0,inf,1\n", ["y = inf m at t = 2 s", "1000 m"]),
        ("t,x,y,z,qx,qy,qz\n0,0,0,0,0,0,0\n", ["qx,qy,qz,qw"]),
        (
            "t,x,y,z,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,2\n",
            ["t = 1 s", "norm 2"],
        ),
    ],
)
def test_a_table_that_is_no_path_is_refused_with_file_and_place(tmp_path, text, words):
    file = tmp_path / "bad.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(ValidationError) as fault:
        PathSpec.model_validate({"csv": str(file)})
    assert all(word in str(fault.value) for word in ["bad.csv", *words]), fault.value


def test_waypoints_at_uneven_times_do_not_swing_out():
    points, times = [[1.0, 0, 0], [1.2, 0, 0], [0.9, 0, 0], [0.0, 0, 0]], [10.0, 10.1, 20.0, 30.0]
    way = offsets_of({"waypoints": {"points_m": points, "times_s": times}})[1][:, 0]
    assert way.max() < 1.2 + 0.5 * 0.2
    assert way.min() > -1e-9


def test_waypoints_are_the_curve_that_their_points_alone_would_be():
    points, times = [[0.2, 0, 0], [0.3, 0.2, 0], [0.1, 0.3, 0.2]], [10.0, 18.0, 30.0]
    goal = goal_of({"waypoints": {"points_m": points, "times_s": times}})
    alone = np.vstack([TOOL, TOOL + points])
    own = EndEffectorPath(PathGoal(np.array([0.0, *times]), alone, np.zeros((0, 4))))
    at = np.linspace(0.0, 30.0, 901)
    assert np.abs(EndEffectorPath(goal).positions(at) - own.positions(at)).max() < 1e-4
