import contextlib
import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from planner_rig import drive, reference_vehicle, short_figure_9
from scipy.spatial.transform import Rotation

from uvms_core.signals import JointGoal, PathGoal, to_seconds
from uvms_planner import GoalRejected, MotionPlanner, PlannerConfig

STEPS = "genetic_steps"
NONE = np.zeros((0, 4))
RUN = drive()
TOOL, TURN = RUN.planner.end_effector


def path(times=(0.0, 10.0), offsets=((0, 0, 0), (0.1, 0, 0)), orientations=NONE):
    positions = TOOL + np.asarray(offsets, dtype=float)
    return PathGoal(np.array(times, dtype=float), positions, np.asarray(orientations, dtype=float))


def turned(*degrees):
    start = Rotation.from_quat(TURN)
    return np.array(
        [(start * Rotation.from_euler("x", d, degrees=True)).as_quat() for d in degrees]
    )


def pitched(*degrees):
    start = Rotation.from_quat(TURN)
    return np.array(
        [(Rotation.from_euler("y", d, degrees=True) * start).as_quat() for d in degrees]
    )


def rejection(goal, run=RUN):
    """The message with which the planner rejects the goal."""
    with pytest.raises(GoalRejected) as caught:
        run.planner.accept(goal)
    return str(caught.value)


@pytest.mark.parametrize(
    ("goal", "message"),
    [
        (path((0.0, np.nan)), "path: times[1] = nan is not finite"),
        (path(offsets=((0, 0, 0), (np.inf, 0, 0))), "path: positions[1] = ["),
        (path((1.0, 2.0)), "path: the first time is 1 s, must be 0"),
        (
            path((0.0, 5.0, 5.0), np.zeros((3, 3))),
            "path: times must increase; times[2] = 5 s after 5 s",
        ),
        (
            path((0.0,), np.zeros((1, 3))),
            "path: times has shape (1,) and positions (1, 3); needed are (k,) and (k, 3) with"
            " k >= 2",
        ),
        (
            path((0.0, 1.0, 2.0)),
            "path: times has shape (3,) and positions (2, 3); needed are (k,) and (k, 3) with"
            " k >= 2",
        ),
        (
            path(orientations=np.ones((1, 4))),
            "path: orientations has shape (1, 4); needed is (2, 4), or (0, 4) for none",
        ),
        (
            path(orientations=[TURN, 2 * TURN]),
            "path: orientations[1] has norm 2, must be a unit quaternion",
        ),
        (
            path((0.0, 900.0), ((0, 0, 0), (0, 0, -12.0))),
            "path: at t = 900 s it is 1.2614 m above the surface (z is down, must be >= 0)",
        ),
        (
            path(offsets=((0.3, 0, 0), (0.4, 0, 0))),
            "path: its first point is 0.3 m from the end effector, allowed 0.1 m; the end effector"
            " is at (1.1118, 0.0700, 10.7386) m",
        ),
        (
            path(orientations=turned(90, 90)),
            "path: its first orientation is 90 deg from the end effector's, allowed 20 deg;",
        ),
    ],
)
def test_malformed_paths_are_rejected_with_value_and_bound(goal, message):
    assert rejection(goal).startswith(message)


def test_a_whole_path_that_is_too_fast_says_which_limit_and_how_much_slower_it_can_be():
    fast = path((0.0, 3.0), ((0, 0, 0), (0.9, 0, 0)))
    match = re.fullmatch(
        r"path too fast: .+: [-\d.]+ (m/s\S*|deg/s\S*) at t = [\d.]+ s, allowed [-\d.]+ \1;"
        r" ([\d.]+) times slower it can be followed, and the goal's time_scale_max is 1",
        rejection(fast),
    )
    factor = float(match[2])
    assert 1.1 < factor < 5.0  # 15/8 of 0.3 m/s where 0.31 are allowed, less what the arm reaches
    run = drive()
    run.planner.accept(replace(fast, time_scale_max=1.05 * factor))
    assert run.until_finished().success
    assert to_seconds(run.references[-1].stamp) > fast.times[-1] * 0.95 * factor


def test_a_whole_path_beyond_the_depth_that_is_allowed_cannot_be_followed_at_any_speed():
    run = drive(limits={"depth_max_m": 10.3})
    text = rejection(path((0.0, 20.0), ((0, 0, 0), (0, 0, 3.0))), run)
    assert text.startswith(
        "path: it cannot be followed, however slowly; in 30 times the time, z of the vehicle: "
    )
    assert text.endswith("allowed 10.3 m")


def test_a_path_that_is_too_fast_says_when_and_by_how_much():
    text = rejection(path((0.0, 10.0), ((0, 0, 0), (3.0, 0, 0))), drive(method=STEPS))
    match = re.fullmatch(
        r"path too fast: at t = ([\d.]+) s it moves at ([\d.]+) m/s; within the rate limits the end"
        r" effector stays ([\d.]+) m behind, allowed 0.001 m",
        text,
    )
    assert 0.0 < float(match[1]) < 10.0
    assert 0.05 < float(match[2]) <= 0.5625  # at most 15/8 of the mean, half-way
    assert float(match[3]) > 1e-3


def test_a_point_that_the_arm_alone_cannot_reach_says_how_far_it_is():
    run = drive(method="arm_only")
    text = rejection(path((0.0, 100.0), ((0, 0, 0), (1.5, 0, 0))), run)
    match = re.fullmatch(
        r"path: at t = ([\d.]+) s the nearest reachable point is ([\d.e-]+) m away, allowed"
        r" 0.001 m",
        text,
    )
    assert 30.0 < float(match[1]) < 80.0
    assert float(match[2]) >= 1e-3


def test_a_depth_that_the_vehicle_may_not_have_is_out_of_reach():
    run = drive(method=STEPS, limits={"depth_max_m": 10.3})
    text = rejection(path((0.0, 400.0), ((0, 0, 0), (0, 0, 3.0))), run)
    assert re.match(r"path: at t = [\d.]+ s the nearest reachable point is [\d.]+ m away", text)


def test_an_orientation_that_the_arm_cannot_take_is_out_of_reach():
    goal = path((0.0, 200.0), ((0, 0, 0), (0, 0, 0)), pitched(0, 170))
    text = rejection(goal, drive(method=STEPS))
    match = re.fullmatch(
        r"path: at t = ([\d.]+) s the nearest reachable orientation is ([\d.]+) deg away, allowed"
        r" 0.5 deg, most of it about the tool's [xyz] axis; with the orientation free nothing is"
        r" asked of it",
        text,
    )
    assert match, text
    assert float(match[2]) >= 0.5


def test_a_turn_that_is_too_fast_says_so():
    fast = path((0.0, 1.0), ((0, 0, 0), (0, 0, 0)), turned(0, 170))
    text = rejection(fast, drive(method=STEPS))
    assert re.fullmatch(
        r"path too fast: at t = [\d.]+ s it turns at [\d.]+ deg/s; within the rate limits the end"
        r" effector stays [\d.]+ (deg|m) behind, allowed [\d.]+ (deg|m)",
        text,
    )


def test_a_goal_before_the_first_odometry_is_rejected():
    planner = MotionPlanner(reference_vehicle(), PlannerConfig(), 1)
    with pytest.raises(GoalRejected) as caught:
        planner.accept(path())
    assert str(caught.value) == "no odometry yet: the planner does not know where the vehicle is"


def test_another_goal_is_rejected_while_one_is_being_planned():
    run = drive()
    proposal = run.planner.propose(short_figure_9(2.0, 0.01).goal(*run.planner.end_effector))
    assert rejection(path(), run) == "another goal is being planned: wait for its answer"
    proposal.work(lambda share, text: None)
    run.planner.begin(proposal)
    assert run.until_finished().success
    run.planner.accept(JointGoal(np.array([5.0]), run.references[-1].q[-1:]))


@pytest.mark.parametrize(
    ("times", "positions_deg", "message"),
    [
        (
            [5.0],
            [[0.0, 0.0, 0.0]],
            "joint goal: times has shape (1,) and positions (1, 3); needed are (k,) and (k, 4)"
            " with k >= 1",
        ),
        ([np.nan], [[0.0] * 4], "joint goal: every time and position must be finite"),
        ([0.0], [[0.0] * 4], "joint goal: times must be > 0 and increasing"),
        ([5.0, 4.0], [[0.0] * 4] * 2, "joint goal: times must be > 0 and increasing"),
        (
            [60.0],
            [[130.0, 10.0, 115.0, 0.0]],
            "joint goal: point 0: joint swing: 130 deg is outside -120 to 120 deg",
        ),
        (
            [5.0],
            [[90.0, 10.0, 115.0, 0.0]],
            "joint goal: point 0: joint swing: needs 33.75 deg/s, limit 20 deg/s; allow more than"
            " 5 s",
        ),
        (
            [10.0, 11.5],
            [[0.0, 10.0, 115.0, 0.0], [0.0, 10.0, 100.0, 0.0]],
            "joint goal: point 1: joint elbow: needs 38.49 deg/s^2, limit 10 deg/s^2; allow more"
            " than 1.5 s",
        ),
    ],
)
def test_joint_goals_beyond_a_limit_name_the_joint(times, positions_deg, message):
    goal = JointGoal(np.array(times), np.deg2rad(np.array(positions_deg)))
    assert rejection(goal) == message


any_float = st.one_of(
    st.floats(-2.0, 20.0), st.sampled_from([np.nan, np.inf, -np.inf, 0.0, 1e300, -1e300])
)


@given(
    count=st.integers(0, 5),
    numbers=st.lists(any_float, min_size=40, max_size=40),
    spare=st.integers(-1, 1),
    oriented=st.booleans(),
)
@settings(max_examples=120, deadline=None)
def test_whatever_comes_is_accepted_or_rejected_and_the_planner_goes_on(
    count, numbers, spare, oriented
):
    values = np.array(numbers)
    times = values[:count]
    points = TOOL + 0.01 * values[5 : 5 + 3 * max(count + spare, 0)].reshape(-1, 3)
    turns = values[20 : 20 + 4 * count].reshape(-1, 4) if oriented else NONE
    with contextlib.suppress(GoalRejected):
        RUN.planner.accept(PathGoal(times, points, turns))
    RUN.planner.cancel()
    step = RUN.advance()
    for signal in step.references:
        for name in ("position", "quaternion", "nu", "nu_dot", "q", "q_dot", "q_ddot"):
            assert np.all(np.isfinite(getattr(signal, name)))
