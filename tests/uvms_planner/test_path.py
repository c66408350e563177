import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.signals import PathGoal
from uvms_planner.joined_path import JoinedPath

NONE = np.zeros((0, 4))
TIMES = np.array([0.0, 1.0, 2.5, 4.0, 6.0])
POINTS = np.array(
    [[0.0, 0.0, 5.0], [1.0, 0.0, 5.0], [2.0, -1.0, 5.0], [2.0, -3.0, 6.0], [2.5, -3.0, 6.0]]
)


def turns(*degrees):
    return np.array([Rotation.from_euler("z", angle, degrees=True).as_quat() for angle in degrees])


def difference(path, time, field, step=1e-6):
    after, before = (
        getattr(path.sample(time + step), field),
        getattr(path.sample(time - step), field),
    )
    return (after - before) / (2 * step)


def test_it_goes_through_every_point_at_its_time():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, NONE))
    for time, point in zip(TIMES, POINTS, strict=True):
        assert np.allclose(path.sample(time).position, point, atol=1e-12)
    assert np.allclose(path.positions(TIMES), POINTS, atol=1e-12)


def test_the_velocity_is_the_derivative_and_continuous_at_the_points():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, NONE))
    for time in (0.3, 1.7, 3.0, 5.9):
        assert np.allclose(
            difference(path, time, "position"), path.sample(time).velocity, atol=1e-7
        )
    for time in TIMES[1:-1]:
        gap = path.sample(time + 1e-9).velocity - path.sample(time - 1e-9).velocity
        assert np.max(np.abs(gap)) < 1e-6


def test_it_is_at_rest_at_both_ends_and_stays_there():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, NONE))
    assert np.all(path.sample(0.0).velocity == 0.0)
    assert np.all(path.sample(6.0).velocity == 0.0)
    assert np.array_equal(path.sample(100.0).position, path.sample(6.0).position)
    assert np.array_equal(path.sample(-1.0).position, POINTS[0])
    assert path.duration == 6.0


@given(
    st.lists(st.floats(0.01, 5.0), min_size=1, max_size=12),
    st.lists(st.floats(-3.0, 3.0), min_size=12, max_size=12),
)
@settings(max_examples=100, deadline=None)
def test_it_leaves_the_range_between_two_points_only_to_turn(gaps, heights):
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    points = np.zeros((len(times), 3))
    points[:, 2] = 10 + np.resize(heights, len(times))
    path = EndEffectorPath(PathGoal(times, points, NONE))
    steps = np.concatenate([[0.0], np.diff(points[:, 2]), [0.0]])
    for index in range(len(gaps)):
        inside = path.positions(np.linspace(times[index], times[index + 1], 15))[:, 2]
        low, high = sorted(points[index : index + 2, 2])
        before, own, after = steps[index : index + 3]
        turns = min(before, own, after) < 0.0 < max(before, own, after)
        allowed = 0.5 * min(abs(before), abs(after)) if turns else 0.0
        assert np.all(inside >= low - allowed - 1e-8)
        assert np.all(inside <= high + allowed + 1e-8)
        if not turns:
            assert np.all(np.diff(inside) * np.sign(own) >= -1e-8)


def test_orientations_follow_great_arcs_with_a_continuous_rate():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, turns(0, 20, 50, 50, 10)))
    for time, angle in zip(TIMES, (0, 20, 50, 50, 10), strict=True):
        turned = Rotation.from_quat(path.sample(time).quaternion).as_euler("zyx", degrees=True)
        assert turned == pytest.approx([angle, 0.0, 0.0], abs=1e-9)
    for time in (0.4, 2.0, 5.0):
        step = 1e-6
        before = Rotation.from_quat(path.sample(time - step).quaternion)
        after = Rotation.from_quat(path.sample(time + step).quaternion)
        rate = (after * before.inv()).as_rotvec() / (2 * step)
        assert np.allclose(rate, path.sample(time).angular_velocity, atol=1e-6)
    assert np.allclose(path.sample(6.0).angular_velocity, 0.0)
    assert np.allclose(path.sample(0.0).angular_velocity, 0.0)


def test_without_orientations_there_are_none():
    sample = EndEffectorPath(PathGoal(TIMES, POINTS, NONE)).sample(1.0)
    assert sample.quaternion is None
    assert sample.angular_velocity is None


def test_a_path_that_begins_beside_the_tool_is_joined_in_time():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, turns(0, 20, 50, 50, 10)))
    start, turn = POINTS[0] + [0.0, 0.05, -0.02], turns(8)[0]
    joined = JoinedPath(path, start, turn, approach=3.0)
    assert np.allclose(joined.sample(0.0).position, start)
    assert np.allclose(np.abs(joined.sample(0.0).quaternion @ turn), 1.0)
    assert np.allclose(joined.sample(0.0).velocity, 0.0)
    for time in (0.5, 1.5, 2.9):
        assert not joined.joined(time)
        rate = difference(joined, time, "position")
        assert np.allclose(rate, joined.sample(time).velocity, atol=1e-6)
        step = 1e-6
        before = Rotation.from_quat(joined.sample(time - step).quaternion)
        after = Rotation.from_quat(joined.sample(time + step).quaternion)
        turning = (after * before.inv()).as_rotvec() / (2 * step)
        assert np.allclose(turning, joined.sample(time).angular_velocity, atol=1e-6)
    assert joined.joined(3.0)
    assert np.array_equal(joined.sample(4.0).position, path.sample(4.0).position)


def test_a_path_that_begins_at_the_tool_is_followed_as_it_is():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, NONE))
    joined = JoinedPath(path, POINTS[0], turns(0)[0], approach=3.0)
    assert joined.joined(0.0)
    assert np.array_equal(joined.sample(1.3).position, path.sample(1.3).position)


def test_a_joined_path_is_smooth_up_to_the_acceleration_and_ends_on_the_path():
    path = EndEffectorPath(PathGoal(TIMES, POINTS, turns(0, 20, 50, 50, 10)))
    tilted = (Rotation.from_rotvec([0.1, -0.2, 0.15]) * Rotation.from_quat(turns(0)[0])).as_quat()
    joined = JoinedPath(path, POINTS[0] + [0.0, 0.05, -0.02], tilted, approach=3.0)
    times, h = np.array([0.2, 0.7, 1.6, 2.4, 2.95, 3.3, 5.0]), 1e-5
    before, now, after = (joined.samples(times + shift) for shift in (-h, 0.0, h))
    rate = (after.velocity - before.velocity) / (2 * h)
    assert np.allclose(rate, now.acceleration, atol=1e-6)
    rate = (after.angular_velocity - before.angular_velocity) / (2 * h)
    assert np.allclose(rate, now.angular_acceleration, atol=1e-6)
    turned = Rotation.from_quat(after.quaternion) * Rotation.from_quat(before.quaternion).inv()
    assert np.allclose(turned.as_rotvec() / (2 * h), now.angular_velocity, atol=1e-6)
    start, met = joined.samples(np.array([-1.0, 0.0])), joined.samples(np.array([3.0, 4.0]))
    for name in ("velocity", "acceleration", "angular_velocity", "angular_acceleration"):
        assert np.abs(getattr(start, name)).max() == 0.0, name
    on_path = path.samples(np.array([3.0, 4.0]))
    for own, other in zip(met, on_path, strict=True):
        assert np.allclose(own, other, atol=1e-14)
    assert np.allclose(joined.positions(times), now.position, atol=0.0)
