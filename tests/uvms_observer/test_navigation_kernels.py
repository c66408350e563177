"""The filter's kernels against their numpy reference and against finite differences."""

import navigation_reference as numpy_reference
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nav_states import NOISE, minus, numeric_jacobian, random_state
from scipy.spatial.transform import Rotation

from uvms_dynamics.kernels.rotations import skew
from uvms_observer.navigation.correction import correct
from uvms_observer.navigation.measurements import dvl, imu, position, pressure
from uvms_observer.navigation.propagation import propagate
from uvms_observer.navigation.state import SIZE

G = 9.81
RATE, FORCE = np.array([0.1, -0.2, 0.3]), np.array([0.4, -0.3, -9.6])
LEVER = np.array([-0.45, 0.1, 0.2])
OPEN = float("inf")
seeds = st.integers(0, 2**32 - 1)


@settings(max_examples=25, deadline=None)
@given(seed=seeds, dt=st.floats(1e-4, 0.1))
def test_propagation_equals_the_numpy_reference(seed, dt):
    state = random_state(seed)
    expected = numpy_reference.propagated(state, RATE, FORCE, dt, G, NOISE)
    propagate(state, RATE - 0.05, RATE + 0.05, FORCE + 0.2, FORCE - 0.2, dt, G, *NOISE)
    for ours, theirs in zip(state, expected, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-10, atol=1e-13)


@pytest.mark.parametrize("seed", range(4))
def test_transition_matrix_is_the_derivative_of_the_propagation(seed):
    state, dt, phi = random_state(seed), 0.01, np.linspace(0.99, 1.0, SIZE - 9)
    nominal = numpy_reference.propagated_mean(state, RATE, FORCE, dt, G, phi)

    def error_after(e):
        moved = numpy_reference.propagated_mean(
            numpy_reference.plus(state, e), RATE, FORCE, dt, G, phi
        )
        return minus(moved, nominal)

    F = numpy_reference.transition_matrix(state, RATE, FORCE, dt, phi)
    numeric = numeric_jacobian(error_after)
    gyro = slice(9, 12)  # its column is exact to first order in the turn of one interval
    np.testing.assert_allclose(F[:, gyro], numeric[:, gyro], atol=1e-6)
    F[:, gyro] = numeric[:, gyro]
    np.testing.assert_allclose(F, numeric, atol=2e-9)


def test_propagation_of_free_fall_and_of_rest():
    state = random_state(1)
    state.velocity[:] = 0.0
    start = state.position.copy()
    still, none = state.accelerometer_bias.copy(), np.zeros(3)
    propagate(state, none, none, still, still, 0.5, G, *NOISE)
    np.testing.assert_allclose(state.velocity, [0.0, 0.0, 0.5 * G], atol=1e-12)
    np.testing.assert_allclose(state.position - start, [0.0, 0.0, 0.125 * G], atol=1e-12)


def test_a_full_turn_brings_the_attitude_back():
    state = random_state(2)
    start = Rotation.from_quat(state.quaternion)
    state.gyro_bias[:] = 0.0
    rate = np.array([0.0, 0.0, 2.0 * np.pi])
    for _ in range(100):
        propagate(state, rate, rate, FORCE, FORCE, 0.01, G, *NOISE)
    assert (Rotation.from_quat(state.quaternion) * start.inv()).magnitude() < 1e-12


EXPECTATIONS = {
    "dvl": lambda state: dvl.velocity(state, LEVER, RATE, False),
    "dvl in water lock": lambda state: dvl.velocity(state, LEVER, RATE, True),
    "pressure": lambda state: pressure.depth(state, LEVER),
    "gps": lambda state: position.position(state, LEVER),
}


@pytest.mark.parametrize("sensor", EXPECTATIONS)
@pytest.mark.parametrize("seed", range(4))
def test_derivative_of_a_reading(sensor, seed):
    state, expect = random_state(seed), EXPECTATIONS[sensor]
    _, H = expect(state)
    numeric = numeric_jacobian(lambda e: expect(numpy_reference.plus(state, e))[0])
    np.testing.assert_allclose(H, numeric, atol=1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_derivative_of_the_gyrocompass_residual(seed):
    """The bias turns with the attitude's error: a product of two small angles, left out."""
    state = random_state(seed)
    state.compass_bias[:] = 0.0
    _, H = imu.attitude(state, state.quaternion)
    numeric = numeric_jacobian(
        lambda e: -imu.attitude(numpy_reference.plus(state, e), state.quaternion)[0]
    )
    np.testing.assert_allclose(H, numeric, atol=1e-8)


@settings(max_examples=25, deadline=None)
@given(seed=seeds, is_fix=st.booleans())
def test_correction_equals_the_numpy_reference(seed, is_fix):
    state, rng = random_state(seed), np.random.default_rng(seed)
    H, residual = rng.standard_normal((3, SIZE)), 0.01 * rng.standard_normal(3)
    expected = numpy_reference.corrected(state, H, residual, np.diag([1e-3, 2e-3, 3e-3]), is_fix)
    correct(state, H, residual, np.diag([1e-3, 2e-3, 3e-3]), OPEN, is_fix)
    for ours, theirs in zip(state[:-1], expected[:-1], strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-8, atol=1e-11)


def test_correction_returns_the_mahalanobis_distance_and_keeps_to_the_gate():
    state = random_state(3)
    before = state.copied()
    H, residual, N = np.eye(3, SIZE), np.array([1.0, 2.0, -1.0]), 0.1 * np.eye(3)
    expected = residual @ np.linalg.solve(H @ before.covariance @ H.T + N, residual)
    assert correct(state, H, residual, N, 0.99 * expected) == pytest.approx(expected, rel=1e-9)
    for name in set(state._fields) - {"innovation"}:
        np.testing.assert_array_equal(getattr(state, name), getattr(before, name))
    S = H @ before.covariance @ H.T + N
    stds = [np.sqrt(np.diag(matrix)) for matrix in (N, S)]
    np.testing.assert_allclose(state.innovation[:, :3], [residual, *stds])
    correct(state, H, residual, N, 1.01 * expected)
    assert np.trace(state.covariance) < np.trace(before.covariance)


@pytest.mark.parametrize("seed", range(4))
def test_many_corrections_keep_the_covariance_symmetric_and_positive(seed):
    state, rng = random_state(seed), np.random.default_rng(seed)
    for _ in range(300):
        propagate(state, RATE, RATE, FORCE, FORCE, 0.01, G, *NOISE)
        imu.correct_attitude(state, state.quaternion.copy(), np.full(3, 1e-10), OPEN)
        expected = dvl.velocity(state, LEVER, RATE, False)[0]
        measured = expected + 1e-4 * rng.standard_normal(3)
        dvl.correct_velocity(state, measured, 1e-8, LEVER, RATE, 0.0, False, OPEN)
        pressure.correct_depth(state, 1.0, 1e-8, LEVER, OPEN)
        np.testing.assert_array_equal(state.covariance, state.covariance.T)
    assert np.linalg.eigvalsh(state.covariance).min() > -1e-15
    assert np.linalg.norm(state.quaternion) == pytest.approx(1.0, abs=1e-14)


def test_gyro_noise_enters_by_the_lever_arm_of_the_dvl():
    quiet, noisy = random_state(5), random_state(5)
    measured = dvl.velocity(quiet, LEVER, RATE, False)[0] + 0.01
    near = dvl.correct_velocity(quiet, measured, 1e-4, LEVER, RATE, 0.0, False, OPEN)
    far = dvl.correct_velocity(noisy, measured, 1e-4, LEVER, RATE, 1e-2, False, OPEN)
    assert far < near


@pytest.mark.parametrize("seed", range(3))
def test_a_correction_keeps_what_the_dvl_has_told_of_its_reading(seed):
    """The reading's error after a correction, linearized where the state is then, has the
    covariance that the correction has left; only the shares of its parts are taken anew."""
    state = random_state(seed)
    measured = dvl.velocity(state, LEVER, RATE, False)[0] + 0.02
    plain = state.copied()
    expected, H = dvl.velocity(plain, LEVER, RATE, False)
    arm = skew(LEVER)
    N = 1e-6 * np.eye(3) + arm @ np.diag(state.excess[:3]) @ arm.T
    correct(plain, H, measured - expected, N, OPEN)
    dvl.correct_velocity(tuple(state), measured, 1e-6, LEVER, RATE, 0.0, False, OPEN)
    np.testing.assert_allclose(state.velocity, plain.velocity, atol=1e-12)
    np.testing.assert_array_equal(state.reference, state.velocity)
    after = dvl.velocity(state, LEVER, RATE, False)[1]
    told, kept = H @ plain.covariance @ H.T, after @ state.covariance @ after.T
    np.testing.assert_allclose(kept, told, rtol=0.02, atol=0.01 * np.abs(told).max())
