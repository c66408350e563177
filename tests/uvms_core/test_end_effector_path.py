"""The path through a goal's points: C2, at rest where it must be, and as smooth as its points."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath, PathSamples
from uvms_core.rotation_vectors import angular_motion, vector_motion
from uvms_core.signals import PathGoal

NONE = np.zeros((0, 4))
DEEP = np.array([1.0, -2.0, 8.0])
gaps = st.lists(st.floats(0.05, 5.0), min_size=2, max_size=10)
seeds = st.integers(0, 10_000)


def random_goal(gaps, seed, turning=False):
    """Any points at any times, with orientations of up to a radian from one to the next."""
    rng = np.random.default_rng(seed)
    times = np.concatenate([[0.0], np.cumsum(gaps)])
    points = DEEP + np.cumsum(rng.normal(0.0, 0.3, (len(times), 3)), axis=0)
    if not turning:
        return PathGoal(times, points, NONE)
    turns, rotations = rng.uniform(-0.6, 0.6, (len(gaps), 3)), [Rotation.random(rng=rng)]
    for turn in turns:
        rotations.append(Rotation.from_rotvec(turn) * rotations[-1])
    return PathGoal(times, points, Rotation.concatenate(rotations).as_quat())


def turned_between(before, after):
    """Rotation vectors (k, 3) in world axes from quaternions `before` to `after` (k, 4)."""
    return (Rotation.from_quat(after) * Rotation.from_quat(before).inv()).as_rotvec()


def inside_segments(times, share=(0.13, 0.5, 0.84)):
    return np.concatenate([times[:-1] + part * np.diff(times) for part in share])


@given(gaps, seeds)
@settings(max_examples=60, deadline=None)
def test_velocity_and_acceleration_are_the_derivatives(gaps, seed):
    goal = random_goal(gaps, seed, turning=True)
    path, times = EndEffectorPath(goal), inside_segments(goal.times)
    h = 1e-5
    before, now, after = (path.samples(times + shift) for shift in (-h, 0.0, h))
    hardest = np.abs(now.acceleration).max() + 1.0
    assert np.allclose((after.position - before.position) / (2 * h), now.velocity, atol=1e-6)
    rate = (after.velocity - before.velocity) / (2 * h)
    assert np.allclose(rate, now.acceleration, atol=1e-5 * hardest)
    omega = turned_between(before.quaternion, after.quaternion) / (2 * h)
    assert np.allclose(omega, now.angular_velocity, atol=1e-5)
    alpha = (after.angular_velocity - before.angular_velocity) / (2 * h)
    hardest = np.abs(now.angular_acceleration).max() + 1.0
    assert np.allclose(alpha, now.angular_acceleration, atol=1e-5 * hardest)


@given(gaps, seeds)
@settings(max_examples=60, deadline=None)
def test_everything_up_to_the_acceleration_is_continuous_at_the_points(gaps, seed):
    goal = random_goal(gaps, seed, turning=True)
    path = EndEffectorPath(goal)
    before, after = (path.samples(goal.times[1:-1] + shift) for shift in (-1e-9, 1e-9))
    times = inside_segments(goal.times)
    for name in PathSamples._fields[:3] + PathSamples._fields[4:]:
        greatest = 1.0 + np.abs(getattr(path.samples(times), name)).max()
        gap = np.abs(getattr(after, name) - getattr(before, name)).max()
        assert gap < 1e-5 * greatest, name  # what passes in 2 ns
    assert np.abs(turned_between(before.quaternion, after.quaternion)).max() < 1e-6
    at = path.samples(goal.times)
    assert np.allclose(at.position, goal.positions, atol=1e-12)
    assert np.abs(turned_between(at.quaternion, goal.orientations)).max() < 1e-7


@given(gaps, seeds)
@settings(max_examples=60, deadline=None)
def test_it_rests_at_both_ends_and_stays_there(gaps, seed):
    goal = random_goal(gaps, seed, turning=True)
    end = float(goal.times[-1])
    samples = EndEffectorPath(goal).samples(np.array([-3.0, 0.0, end, end + 5.0]))
    for name in ("velocity", "acceleration", "angular_velocity", "angular_acceleration"):
        assert np.all(getattr(samples, name) == 0.0), name
    assert np.array_equal(samples.position[[0, 1]], goal.positions[[0, 0]])
    assert np.array_equal(samples.position[[2, 3]], goal.positions[[-1, -1]])


def circle(angle, radius=0.3):
    axes = Rotation.from_euler("ZYX", [0.4, 0.3, -0.7]).as_matrix()
    return DEEP + radius * (np.cos(angle)[:, None] * axes[0] + np.sin(angle)[:, None] * axes[1])


@pytest.mark.parametrize("points", [24, 36, 240])
def test_a_circle_is_a_circle_up_to_its_acceleration(points):
    """Constant speed: away from the ends the acceleration is omega^2 r towards the centre."""
    period, rounds = 60.0, 4
    times = np.linspace(0.0, rounds * period, rounds * points + 1)
    omega = 2 * np.pi / period
    path = EndEffectorPath(PathGoal(times, circle(omega * times), NONE))
    within = np.linspace(period, 3 * period, 7919)
    exact = -(omega**2) * (circle(omega * within) - DEEP)
    samples = path.samples(within)
    gap = np.linalg.norm(samples.acceleration - exact, axis=1).max()
    assert gap < 0.01 * omega**2 * 0.3
    assert np.abs(np.linalg.norm(samples.position - DEEP, axis=1) - 0.3).max() < 2e-5


def test_a_turn_at_a_constant_rate_about_a_tilted_axis_stays_one():
    times = np.linspace(0.0, 60.0, 61)
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    turns = Rotation.from_rotvec(np.outer(0.2 * times, axis)) * Rotation.random(rng=3)
    points = np.tile(DEEP, (61, 1))
    path = EndEffectorPath(PathGoal(times, points, turns.as_quat()))
    samples = path.samples(np.linspace(10.0, 50.0, 997))
    assert np.allclose(samples.angular_velocity, 0.2 * axis, atol=1e-12)
    assert np.allclose(samples.angular_acceleration, 0.0, atol=1e-12)


def test_a_tumbling_tool_has_the_angular_acceleration_of_its_motion():
    """Precession: R = Rz(a t) Ry(b) Rz(c t) has omega = a z + c u, alpha = a z x c u."""
    a, b, c = 0.3, 0.8, 0.5

    def attitude(t):
        return (
            Rotation.from_rotvec(np.outer(t, [0.0, 0.0, a]))
            * Rotation.from_rotvec([0.0, b, 0.0])
            * Rotation.from_rotvec(np.outer(t, [0.0, 0.0, c]))
        )

    times = np.linspace(0.0, 40.0, 161)
    goal = PathGoal(times, np.tile(DEEP, (161, 1)), attitude(times).as_quat())
    within = np.linspace(5.0, 35.0, 1213)
    samples = EndEffectorPath(goal).samples(within)
    spin = c * attitude(within).apply([0.0, 0.0, 1.0])
    upright = np.array([0.0, 0.0, a])
    assert np.abs(samples.angular_velocity - (upright + spin)).max() < 1e-5
    exact = np.cross(upright, spin)
    assert np.abs(samples.angular_acceleration - exact).max() < 1e-3 * np.linalg.norm(exact[0])


def test_a_pause_is_a_pause():
    """Points and orientations that repeat: nothing moves between them, and there is rest."""
    times = np.array([0.0, 1.0, 2.0, 3.0, 6.0, 7.0, 7.5])
    points = DEEP + np.array([0.0, 0.1, 0.3, 0.35, 0.35, 0.1, 0.0])[:, None] * [1.0, -2.0, 0.5]
    turns = Rotation.from_rotvec(np.array([0, 1, 1, 1, 2, 3, 3])[:, None] * [0.1, 0.2, -0.1])
    path = EndEffectorPath(PathGoal(times, points, turns.as_quat()))
    standing = path.samples(np.linspace(3.0, 6.0, 101))
    assert np.all(standing.position == points[3])
    assert np.all(standing.velocity == 0.0)
    assert np.all(standing.acceleration == 0.0)
    steady = path.samples(np.linspace(1.0, 3.0, 101))
    assert np.abs(steady.angular_velocity).max() == 0.0
    assert np.abs(turned_between(steady.quaternion, steady.quaternion[[0] * 101])).max() < 1e-12


def test_uneven_times_do_not_make_it_swing_out():
    """A short fast step between slow ones: a spline through these points leaves them by metres."""
    times = np.array([0.0, 10.0, 10.1, 20.0, 30.0])
    points = np.tile(DEEP, (5, 1))
    points[:, 0] = [0.0, 1.0, 1.2, 0.9, 0.0]
    way = EndEffectorPath(PathGoal(times, points, NONE)).positions(np.linspace(0.0, 30.0, 3001))
    assert way[:, 0].max() < 1.2 + 0.5 * 0.2
    assert way[:, 0].min() >= -1e-12


def test_rows_of_samples_are_the_single_samples():
    path = EndEffectorPath(random_goal([1.0, 0.3, 2.0, 1.1], 4, turning=True))
    times = np.linspace(-0.5, 5.0, 23)
    together = path.samples(times)
    for row, time in enumerate(times):
        one = path.sample(float(time))
        assert np.array_equal(one.position, together.position[row])
        assert np.array_equal(one.velocity, together.velocity[row])
        assert np.array_equal(one.quaternion, together.quaternion[row])
        assert np.array_equal(one.angular_velocity, together.angular_velocity[row])
    assert np.array_equal(path.positions(times), together.position)


def test_the_sign_of_a_quaternion_means_nothing():
    goal = random_goal([1.0] * 6, 9, turning=True)
    flipped = goal.orientations * np.array([1, -1, 1, 1, -1, -1, 1])[:, None]
    times = np.linspace(0.0, 6.0, 301)
    own = EndEffectorPath(goal).samples(times)
    other = EndEffectorPath(PathGoal(goal.times, goal.positions, flipped)).samples(times)
    assert np.allclose(own.angular_velocity, other.angular_velocity, atol=1e-12)
    assert np.all(np.sum(own.quaternion[1:] * own.quaternion[:-1], axis=1) > 0.9)


@given(st.floats(0.0, 3.1), seeds)
@settings(max_examples=60, deadline=None)
def test_rotation_vectors_move_as_their_angular_motion_says(angle, seed):
    rng = np.random.default_rng(seed)
    direction = rng.normal(size=3)
    phi = angle * direction / np.linalg.norm(direction)
    rate, second = rng.normal(size=(2, 3))
    omega, alpha = angular_motion(phi[None], rate[None], second[None])
    back = vector_motion(phi[None], omega, alpha)
    assert np.allclose(back[0], rate, atol=1e-9)
    assert np.allclose(back[1], second, atol=1e-8)

    def at(t):
        return Rotation.from_rotvec(phi + rate * t + 0.5 * second * t**2)

    h = 1e-4
    forward, backward = (at(h) * at(0).inv()).as_rotvec(), (at(-h) * at(0).inv()).as_rotvec()
    assert np.allclose((forward - backward) / (2 * h), omega[0], atol=1e-6)
    assert np.allclose((forward + backward) / h**2, alpha[0], atol=1e-5)
