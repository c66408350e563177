"""The target's pose in the filter: against finite differences and one joint covariance."""

import numpy as np
import pytest
from nav_states import NOISE, random_state
from navigation_reference import plus
from scipy.spatial.transform import Rotation

from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.measurements.target_marker import (
    correct_marker,
    first_sight,
    sight,
)
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.state import SIZE
from uvms_observer.navigation.target import POSE, TARGET_SIZE, with_target

LEVER = np.array([0.8, -0.1, 0.2])
MOUNT = Rotation.from_euler("ZYX", [20.0, -70.0, 5.0], degrees=True).as_matrix()
N = np.diag(np.square([0.004, 0.005, 0.006, 0.02, 0.03, 0.01]))
OPEN = float("inf")
JOINT_SIZE = SIZE + TARGET_SIZE
PARTS = ("position", "velocity", "gyro_bias", "accelerometer_bias", "compass_bias", "further")


def state_with_target(seed):
    """A random state with a target 1.5 m below, correlated with it."""
    state, rng = random_state(seed), np.random.default_rng(seed)
    place = state.position + np.array([0.9, -0.2, 1.5])
    turn = Rotation.from_euler("x", 180.0, degrees=True) * Rotation.random(random_state=seed)
    state = with_target(state, place, turn.as_quat(), np.square([0.02] * 3 + [0.05] * 3))
    scale = np.sqrt(np.diagonal(state.covariance))
    mix = 0.1 * rng.standard_normal((TARGET_SIZE, SIZE)) / np.sqrt(SIZE)
    own = mix @ np.diag(scale) @ np.linalg.solve(np.diag(scale), state.covariance)
    state.cross[:] = 0.1 * own
    state.target_covariance[:] += state.cross @ np.linalg.pinv(state.covariance) @ state.cross.T
    return state


def joint(state):
    """Covariance (26, 26) of the state's error and of the target's."""
    return np.block([[state.covariance, state.cross.T], [state.cross, state.target_covariance]])


def moved(state, e):
    """The state with an error (26,)."""
    turned = Rotation.from_rotvec(e[SIZE + 3 :]) * Rotation.from_quat(state.target[3:])
    place = state.target[:3] + e[SIZE : SIZE + 3]
    return plus(state, e[:SIZE])._replace(target=np.concatenate([place, turned.as_quat()]))


def seen(state):
    """Pose of the target in the camera's axes, in plain formulas."""
    R = Rotation.from_quat(state.quaternion).as_matrix()
    to_camera = (R @ MOUNT).T
    place = to_camera @ (state.target[:3] - state.position - R @ LEVER)
    return place, to_camera @ Rotation.from_quat(state.target[3:]).as_matrix()


def joint_correction(state, H, residual, noise):
    """State (26,) and covariance after one measurement with the optimal gain."""
    P = joint(state)
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + noise)
    left = np.eye(JOINT_SIZE) - K @ H
    return moved(state, K @ residual), left @ P @ left.T + K @ noise @ K.T


def assert_is(state, expected, covariance):
    for name in ("position", "velocity", "target"):
        np.testing.assert_allclose(getattr(state, name), getattr(expected, name), atol=1e-9)
    np.testing.assert_allclose(joint(state), covariance, rtol=1e-7, atol=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_derivative_of_a_sight(seed):
    state = state_with_target(seed)
    place, attitude, H = sight(state, LEVER, MOUNT, 0)
    np.testing.assert_allclose(place, seen(state)[0], atol=1e-12)
    turned = Rotation.from_quat(attitude).as_matrix()
    np.testing.assert_allclose(turned, seen(state)[1], atol=1e-12)

    def change(e):
        place_e, R_e = seen(moved(state, e))
        turn = Rotation.from_matrix(R_e @ turned.T).as_rotvec()
        return np.concatenate([place_e, turn])

    h = 1e-6
    columns = [(change(h * e) - change(-h * e)) / (2.0 * h) for e in np.eye(JOINT_SIZE)]
    np.testing.assert_allclose(H, np.transpose(columns), atol=1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_a_sight_corrects_vehicle_and_target_together(seed):
    state = state_with_target(seed)
    place, attitude, H = sight(state, LEVER, MOUNT, 0)
    residual = 0.01 * np.random.default_rng(seed).standard_normal(6)
    expected, covariance = joint_correction(state, H, residual, N)
    turned = Rotation.from_rotvec(residual[3:]) * Rotation.from_quat(attitude)
    distance = residual @ np.linalg.solve(H @ joint(state) @ H.T + N, residual)
    got = correct_marker(state, place + residual[:3], turned.as_quat(), N, LEVER, MOUNT, 0, OPEN)
    assert got == pytest.approx(distance, rel=1e-6)
    assert_is(state, expected, covariance)


@pytest.mark.parametrize("seed", range(4))
def test_another_measurement_corrects_the_target_by_what_they_have_in_common(seed):
    state, rng = state_with_target(seed), np.random.default_rng(seed)
    H, residual = rng.standard_normal((3, SIZE)), 0.01 * rng.standard_normal(3)
    noise = np.diag([1e-3, 2e-3, 3e-3])
    full = np.hstack([H, np.zeros((3, TARGET_SIZE))])
    expected, covariance = joint_correction(state, full, residual, noise)
    correct(state, H, residual, noise, OPEN, True)
    assert_is(state, expected, covariance)


@pytest.mark.parametrize("seed", range(2))
def test_a_vehicle_that_is_not_corrected_by_the_best_gain_keeps_the_joint_covariance_right(seed):
    """What is no fix leaves the DVL's misalignment as it is: the covariance is Joseph's."""
    state, rng = state_with_target(seed), np.random.default_rng(seed)
    H, noise = rng.standard_normal((3, SIZE)), np.diag([1e-3, 2e-3, 3e-3])
    P, none = joint(state), np.zeros((3, TARGET_SIZE))
    K = np.empty((JOINT_SIZE, 3))
    for axis, residual in enumerate(np.eye(3)):  # the gain shows in what a residual changes
        probe = state.copied()
        correct(probe, H, 1e-6 * residual, noise, OPEN, False)
        turn = Rotation.from_quat(probe.quaternion) * Rotation.from_quat(state.quaternion).inv()
        parts = [getattr(probe, name) - getattr(state, name) for name in PARTS]
        vehicle = np.concatenate([*parts[:2], turn.as_rotvec(), *parts[2:]])
        turn = Rotation.from_quat(probe.target[3:]) * Rotation.from_quat(state.target[3:]).inv()
        target = np.concatenate([probe.target[:3] - state.target[:3], turn.as_rotvec()])
        K[:, axis] = np.concatenate([vehicle, target]) / 1e-6
    left = np.eye(JOINT_SIZE) - K @ np.hstack([H, none])
    correct(state, H, np.zeros(3), noise, OPEN, False)
    np.testing.assert_allclose(joint(state), left @ P @ left.T + K @ noise @ K.T, atol=1e-7)


def test_the_target_stays_where_it_is_while_the_vehicle_moves():
    state, other = state_with_target(1), random_state(1)
    rate, force = np.array([0.1, -0.2, 0.3]), np.array([0.4, -0.3, -9.6])
    whole = joint(state)
    F = np.eye(JOINT_SIZE)
    before = state.target.copy()
    for e, column in zip(np.eye(SIZE), F.T, strict=False):
        probe = with_target(random_state(1), before[:3], before[3:], np.zeros(6))
        probe.cross[0] = e
        propagate(tuple(probe), rate, rate, force, force, 0.01, 9.81, *NOISE)
        column[:SIZE] = probe.cross[0]
    propagate(tuple(state), rate, rate, force, force, 0.01, 9.81, *NOISE)
    propagate(tuple(other), rate, rate, force, force, 0.01, 9.81, *NOISE)
    np.testing.assert_array_equal(state.target, before)
    np.testing.assert_array_equal(state.covariance, other.covariance)
    np.testing.assert_allclose(state.cross, (F @ whole @ F.T)[SIZE:, :SIZE], atol=1e-14)


@pytest.mark.parametrize("seed", range(2))
def test_the_first_sight_makes_the_target_as_uncertain_as_the_vehicle_and_no_more(seed):
    state = with_target(random_state(seed), np.zeros(3), np.zeros(4), np.zeros(6))
    place = np.array([0.1, -0.2, 1.4])
    attitude = Rotation.random(random_state=seed).as_quat()
    first_sight(state, place, attitude, N, LEVER, MOUNT, 0)
    expected, expected_attitude, H = sight(state, LEVER, MOUNT, 0)
    np.testing.assert_allclose(expected, place, atol=1e-12)
    assert abs(expected_attitude @ attitude) == pytest.approx(1.0)
    # what is seen next differs from the first sight by the noise of the first one alone
    np.testing.assert_allclose(H @ joint(state) @ H.T, N, atol=1e-12)
    assert np.linalg.eigvalsh(joint(state)).min() > -1e-12


def test_a_sight_far_off_is_refused():
    state = state_with_target(2)
    place, attitude, _ = sight(state, LEVER, MOUNT, 0)
    before = state.copied()
    assert correct_marker(state, place + 20.0, attitude, N, LEVER, MOUNT, 0, 20.0) > 20.0
    for name in ("position", "quaternion", "covariance", "target", "cross", "target_covariance"):
        np.testing.assert_array_equal(getattr(state, name), getattr(before, name))


def with_second(seed, known=True):
    """A state with two targets, the second one correlated with vehicle and first, or unknown."""
    state = state_with_target(seed)
    zero = np.zeros(3), np.zeros(4), np.zeros(6)
    state = with_target(state, *zero)
    if known:
        place = np.array([-0.4, 0.3, 1.7])
        turn = Rotation.random(random_state=seed + 9).as_quat()
        first_sight(state, place, turn, N, LEVER, MOUNT, 1)
        state.covariance[range(9), range(9)] += 0.01  # the vehicle has moved since
        seen_again = sight(state, LEVER, MOUNT, 0)[:2]
        correct_marker(state, *seen_again, N, LEVER, MOUNT, 0, OPEN)
    return state


def moved_both(state, e):
    """The state with an error (SIZE + 12,)."""
    poses = []
    for index in range(2):
        own = e[SIZE + TARGET_SIZE * index :][:TARGET_SIZE]
        pose = state.target[POSE * index :][:POSE]
        turned = Rotation.from_rotvec(own[3:]) * Rotation.from_quat(pose[3:])
        poses += [pose[:3] + own[:3], turned.as_quat()]
    return plus(state, e[:SIZE])._replace(target=np.concatenate(poses))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("index", [0, 1])
def test_a_sight_of_one_target_corrects_the_other_by_what_they_have_in_common(seed, index):
    state = with_second(seed)
    place, attitude, H = sight(state, LEVER, MOUNT, index)
    residual, P = 0.01 * np.random.default_rng(seed).standard_normal(6), joint(state)
    K = P @ H.T @ np.linalg.inv(H @ P @ H.T + N)
    left = np.eye(len(P)) - K @ H
    expected, covariance = moved_both(state, K @ residual), left @ P @ left.T + K @ N @ K.T
    other = SIZE + TARGET_SIZE * (1 - index)
    assert np.abs(K[other : other + 3]).max() > 1e-3  # or there were nothing to test
    turned = Rotation.from_rotvec(residual[3:]) * Rotation.from_quat(attitude)
    seen_at = place + residual[:3]
    correct_marker(state, seen_at, turned.as_quat(), N, LEVER, MOUNT, index, OPEN)
    assert_is(state, expected, covariance)


@pytest.mark.parametrize("seed", range(3))
def test_what_is_measured_of_the_vehicle_corrects_both_targets(seed):
    state, rng = with_second(seed), np.random.default_rng(seed)
    H, residual = rng.standard_normal((3, SIZE)), 0.01 * rng.standard_normal(3)
    noise, P = np.diag([1e-3, 2e-3, 3e-3]), joint(state)
    full = np.hstack([H, np.zeros((3, 2 * TARGET_SIZE))])
    K = P @ full.T @ np.linalg.inv(full @ P @ full.T + noise)
    left = np.eye(len(P)) - K @ full
    expected, covariance = moved_both(state, K @ residual), left @ P @ left.T + K @ noise @ K.T
    correct(state, H, residual, noise, OPEN, True)
    assert_is(state, expected, covariance)


@pytest.mark.parametrize("seed", range(2))
def test_a_target_that_nobody_has_seen_stays_nowhere(seed):
    state = with_second(seed, known=False)
    place, attitude, _ = sight(state, LEVER, MOUNT, 0)
    correct_marker(state, place + 0.01, attitude, N, LEVER, MOUNT, 0, OPEN)
    np.testing.assert_array_equal(state.target[POSE:], 0.0)
    np.testing.assert_array_equal(joint(state)[SIZE + TARGET_SIZE :], 0.0)
    first_sight(state, np.array([0.0, 0.2, 1.0]), attitude, N, LEVER, MOUNT, 1)
    *_, H = sight(state, LEVER, MOUNT, 1)
    np.testing.assert_allclose(H @ joint(state) @ H.T, N, atol=1e-12)
    assert np.linalg.eigvalsh(joint(state)).min() > -1e-12
