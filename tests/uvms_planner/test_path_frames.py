"""Paths from the tool's start, in map_ned or in map; and what the tool looks at on them."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from planner_rig import drive
from pydantic import ValidationError
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.errors import SignalError
from uvms_core.signals import PathGoal
from uvms_planner import GoalRejected, PathSpec
from uvms_planner.joined_path import JoinedPath

TOOL = np.array([1.0, 2.0, 5.0])
TURNED = Rotation.from_euler("ZYX", [40.0, 20.0, -10.0], degrees=True)
ENU = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
POINTS = np.array([[1.2, 2.1, 5.3], [1.0, 2.4, 5.1]])


def goal_of(word, **more) -> PathGoal:
    return PathSpec.model_validate({**word, **more}).goal(TOOL, TURNED.as_quat())


def waypoints(points, **more):
    return {"waypoints": {"points_m": np.asarray(points).tolist(), **more}}


def test_absolute_waypoints_begin_at_the_tool_and_go_where_they_say():
    goal = goal_of(waypoints(POINTS, times_s=[5.0, 9.0]), frame="map_ned")
    assert np.array_equal(goal.positions[0], TOOL)
    at = np.searchsorted(goal.times, [5.0, 9.0])
    assert np.allclose(goal.positions[at], POINTS, atol=1e-12)
    relative = goal_of(waypoints(POINTS - TOOL, times_s=[5.0, 9.0]))
    assert np.allclose(goal.positions, relative.positions, atol=1e-12)


def test_the_first_way_of_absolute_waypoints_is_that_from_the_tool():
    goal = goal_of(waypoints(POINTS, speeds_m_s=0.1), frame="map_ned")
    lengths = np.linalg.norm(np.diff(np.vstack([TOOL, POINTS]), axis=0), axis=1)
    assert goal.times[-1] == pytest.approx(lengths.sum() / 0.1)


def test_an_absolute_point_where_the_tool_is_needs_a_time():
    spec = PathSpec.model_validate({**waypoints([TOOL], speeds_m_s=0.1), "frame": "map_ned"})
    with pytest.raises(ValueError, match=r"points_m\.0: is where the point before it is"):
        spec.goal(TOOL, TURNED.as_quat())
    origin = {**waypoints([[0.0, 0.0, 0.0]], speeds_m_s=0.1), "frame": "map_ned"}
    PathSpec.model_validate(origin)  # a place like any other


def every_absolute_word(folder):
    rows = np.column_stack([[0.0, 3.0, 7.0], np.vstack([TOOL, POINTS])])
    for name, axes in (("map_ned", np.eye(3)), ("map", ENU)):
        with (folder / f"{name}.csv").open("w", newline="") as stream:
            table = np.column_stack([rows[:, 0], rows[:, 1:] @ axes.T])
            csv.writer(stream).writerows([["t", "x", "y", "z"], *table.tolist()])

    def words(name, axes):
        own = POINTS @ axes.T
        return [
            {"line": {"to_m": own[0].tolist(), "duration_s": 8.0}},
            {"phases": [{"duration_s": 5.0, "to_m": p.tolist()} for p in own]},
            waypoints(own, times_s=[4.0, 9.0]),
            waypoints(own, times_s=[4.0, 9.0], stop=True),
            {"csv": str(folder / f"{name}.csv")},
        ]

    return zip(words("map_ned", np.eye(3)), words("map", ENU), strict=True)


def test_every_word_is_the_same_path_in_both_absolute_frames(tmp_path):
    for in_ned, in_map in every_absolute_word(tmp_path):
        ned, enu = goal_of(in_ned, frame="map_ned"), goal_of(in_map, frame="map")
        assert np.array_equal(ned.times, enu.times)
        assert np.allclose(ned.positions, enu.positions, atol=1e-12), in_ned
        assert np.allclose(ned.positions[0], TOOL, atol=1e-12)


def test_a_circle_in_map_lies_in_the_plane_of_its_axes():
    circle = {"circle": {"radius_m": 0.2, "plane": "XOZ", "turns": 0.25, "duration_s": 9.0}}
    offset = goal_of(circle, frame="map").positions[-1] - TOOL
    # a quarter turn from the first axis to the second, backwards about a centre in the east
    assert np.allclose(ENU @ offset, [0.2, 0.0, -0.2], atol=1e-12)


@pytest.mark.parametrize("frame", ["map_ned", "map"])
def test_absolute_orientations_are_those_that_are_given(frame):
    rpy = [[10.0, -20.0, 130.0], [0.0, 5.0, 90.0]]
    axes = np.eye(3) if frame == "map_ned" else ENU
    points = (POINTS @ axes.T).tolist()
    word = waypoints(points, times_s=[4.0, 9.0], rpy_deg=rpy)
    goal = goal_of(word, frame=frame)
    wanted = Rotation.from_euler("ZYX", np.array(rpy)[:, ::-1], degrees=True).as_matrix()
    found = Rotation.from_quat(goal.orientations).as_matrix()
    at = np.searchsorted(goal.times, [4.0, 9.0])
    assert np.allclose(axes @ found[at], wanted, atol=1e-12)
    assert np.allclose(found[0], TURNED.as_matrix(), atol=1e-12)


def test_an_absolute_path_cannot_be_scaled():
    spec = PathSpec.model_validate({**waypoints(POINTS, times_s=[5.0, 9.0]), "frame": "map"})
    assert spec.scaled(1.0) == spec
    with pytest.raises(ValueError, match="frame: map is absolute"):
        spec.scaled(2.0)


LINE = {"line": {"to_m": [0.1, 0.0, 0.2], "duration_s": 10.0}}
TURNING = waypoints([[0.1, 0.0, 0.0]], times_s=[5.0], rpy_deg=[[0.0, 0.0, 20.0]])


def test_the_words_of_orientation():
    assert goal_of(LINE, orientation="free").orientations.shape == (0, 4)
    keep = goal_of(LINE, orientation="keep")
    assert np.all(keep.orientations == TURNED.as_quat())
    full = goal_of(TURNING)
    assert np.array_equal(full.orientations, goal_of(TURNING, orientation="full").orientations)
    assert np.ptp(full.orientations, axis=0).max() > 0.1
    assert goal_of(TURNING, orientation="free").orientations.shape == (0, 4)
    assert np.all(goal_of(TURNING, orientation="keep").orientations == TURNED.as_quat())


def test_an_axis_points_where_it_did_or_where_it_is_told():
    goal = goal_of(LINE, orientation="axis", tool_axis=[0.0, 0.0, 2.0])
    assert np.array_equal(goal.tool_axis, [0.0, 0.0, 1.0])
    assert goal.axis_directions.shape == goal.positions.shape
    assert np.allclose(goal.axis_directions, TURNED.as_matrix()[:, 2])
    down = goal_of(LINE, orientation="axis", tool_axis=[1, 0, 0], axis_along=[0, 0, 3])
    assert np.allclose(down.axis_directions, [0.0, 0.0, 1.0])
    up = goal_of(
        {"line": {"to_m": [2.0, 1.0, -4.0], "duration_s": 10.0}},
        frame="map",
        orientation="axis",
        tool_axis=[1, 0, 0],
        axis_along=[0, 0, 3],
    )
    assert np.allclose(up.axis_directions, [0.0, 0.0, -1.0])


@pytest.mark.parametrize(
    ("fields", "words"),
    [
        ({"orientation": "full"}, "full needs rpy_deg"),
        ({"orientation": "axis"}, "tool_axis: needed with orientation axis"),
        ({"tool_axis": [1, 0, 0]}, "only there"),
        ({"orientation": "keep", "axis_along": [1, 0, 0]}, "axis_along: only with"),
        ({"orientation": "axis", "tool_axis": [0, 0, 0]}, "tool_axis: must not be zero"),
        ({"keep_orientation": True, "orientation": "free"}, "orientation is 'free'"),
        ({"frame": "odom"}, "'start', 'map_ned' or 'map'"),
        ({"time_scaling": "allowed", "time_scale_max": 0.5}, "greater than or equal to 1"),
    ],
)
def test_what_does_not_fit_together_is_refused(fields, words):
    with pytest.raises(ValidationError, match=words):
        PathSpec.model_validate({**LINE, **fields})


def test_a_path_may_be_followed_slower_where_that_is_allowed():
    assert goal_of(LINE).time_scale_max == 1.0
    assert goal_of(LINE, time_scale_max=4.0).time_scale_max == 1.0
    goal = goal_of(LINE, time_scaling="allowed", time_scale_max=4.0)
    assert goal.time_scale_max == 4.0
    once, slow = EndEffectorPath(goal), EndEffectorPath(goal.slowed(2.5))
    times = np.linspace(0.0, 10.0, 57)
    own, slower = once.samples(times), slow.samples(2.5 * times)
    assert slow.duration == 25.0
    assert np.allclose(slower.position, own.position, atol=1e-12)
    assert np.allclose(2.5 * slower.velocity, own.velocity, atol=1e-12)
    assert np.allclose(2.5**2 * slower.acceleration, own.acceleration, atol=1e-12)


def pointing_goal() -> PathGoal:
    """Swings from down to 75 degrees off in a tilted plane, with a pause."""
    goal = goal_of({"phases": [{"duration_s": 20.0, "to_m": [0.1, 0.1, 0.1]}]})
    angle = np.concatenate([np.linspace(0.0, 1.3, 11) ** 2 / 1.3, np.full(10, 1.3)])
    across = np.array([0.6, 0.8, 0.0])
    rows = np.cos(angle)[:, None] * np.eye(3)[2] + np.sin(angle)[:, None] * across
    return replace(goal, tool_axis=np.eye(3)[0], axis_directions=rows)


def test_directions_are_unit_vectors_with_their_derivatives():
    goal = pointing_goal()
    path = EndEffectorPath(goal)
    off = Rotation.from_rotvec([0.0, np.pi / 2, 0.0]).as_matrix()  # takes x to -z
    tool = Rotation.from_matrix(off.T) * Rotation.from_rotvec([0.05, 0.2, -0.1])
    joined = JoinedPath(path, goal.positions[0], tool.as_quat(), 8.0)
    start = joined.directions(np.zeros(1))
    assert np.allclose(start.direction[0], tool.apply(goal.tool_axis), atol=1e-12)
    assert np.abs(start.rate).max() < 1e-12
    h, times = 1e-5, np.array([0.4, 2.3, 5.5, 7.9, 9.6, 13.0])
    for way in (path, joined):
        before, now, after = (way.directions(times + shift) for shift in (-h, 0.0, h))
        assert np.allclose(np.linalg.norm(now.direction, axis=1), 1.0, atol=1e-12)
        rate = (after.direction - before.direction) / (2 * h)
        assert np.allclose(rate, now.rate, atol=1e-8)
        bend = (after.rate - before.rate) / (2 * h)
        assert np.allclose(bend, now.acceleration, atol=1e-7)
    assert np.allclose(joined.directions(times[4:]).direction, path.directions(times[4:]).direction)
    at = path.directions(goal.times).direction
    assert np.allclose(at, goal.axis_directions, atol=1e-12)


def test_a_path_without_an_axis_has_no_directions():
    path = EndEffectorPath(goal_of(LINE))
    assert path.tool_axis is None
    with pytest.raises(SignalError, match="no tool_axis"):
        path.directions(np.zeros(1))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"tool_axis": np.array([1.0, 0.0])}, "tool_axis has shape"),
        ({"tool_axis": np.array([2.0, 0.0, 0.0])}, "no unit vector"),
        ({"axis_directions": np.empty((0, 3))}, r"axis_directions \(0, 3\)"),
        ({"axis_directions": np.full((21, 3), np.nan)}, "no unit vector"),
        ({"orientations": np.tile([0.0, 0.0, 0.0, 1.0], (21, 1))}, "leave out one of them"),
        ({"axis_directions": np.eye(3)[np.arange(21) % 3]}, "a right angle or more"),
        ({"time_scale_max": 0.5}, "time_scale_max is 0.5"),
        ({}, "deg from its first direction"),
    ],
)
def test_a_goal_that_points_nowhere_sensible_is_rejected(changes, words):
    run = drive()
    goal = pointing_goal()
    own = goal.positions - goal.positions[0] + run.planner.end_effector[0]
    with pytest.raises(GoalRejected, match=words):
        run.planner.accept(replace(goal, positions=own, **changes))


def test_a_method_that_plans_step_by_step_says_who_follows_an_axis():
    run = drive(method="genetic_steps")
    spec = PathSpec.model_validate({**LINE, "orientation": "axis", "tool_axis": [0, 0, 1]})
    with pytest.raises(GoalRejected) as caught:
        run.planner.accept(spec.goal(*run.planner.end_effector))
    assert str(caught.value) == (
        "path: the method genetic_steps follows no tool_axis; planner.method genetic does, or give"
        " whole orientations, or none"
    )
