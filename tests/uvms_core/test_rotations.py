"""Group axioms, and scipy as an independent implementation."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from uvms_dynamics.kernels import rotations as rot

untimed = settings(deadline=None)  # the first call compiles
NUMBERS = st.floats(-1.0, 1.0)
VECTORS = st.tuples(NUMBERS, NUMBERS, NUMBERS).map(np.array)
ANGLES = st.floats(-3.1, 3.1)


@st.composite
def quaternions(draw):
    a = np.array(draw(st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS)))
    assume(np.linalg.norm(a) > 1e-2)
    return rot.quat_normalize(a)


def same_turn(a, b):
    np.testing.assert_allclose(abs(a @ b), 1.0, atol=1e-12)


@untimed
@given(quaternions(), quaternions(), quaternions())
def test_product_is_associative_and_follows_the_matrices(a, b, c):
    left = rot.quat_multiply(rot.quat_multiply(a, b), c)
    np.testing.assert_allclose(left, rot.quat_multiply(a, rot.quat_multiply(b, c)), atol=1e-14)
    product = rot.quat_to_matrix(a) @ rot.quat_to_matrix(b)
    np.testing.assert_allclose(rot.quat_to_matrix(rot.quat_multiply(a, b)), product, atol=1e-14)


@untimed
@given(quaternions())
def test_conjugate_is_the_inverse(a):
    product = rot.quat_multiply(a, rot.quat_conjugate(a))
    np.testing.assert_allclose(product, [0.0, 0.0, 0.0, 1.0], atol=1e-15)


@untimed
@given(quaternions())
def test_matrix_is_scipys_and_comes_back(a):
    matrix = rot.quat_to_matrix(a)
    np.testing.assert_allclose(matrix, Rotation.from_quat(a).as_matrix(), atol=1e-14)
    back = rot.matrix_to_quat(matrix)
    assert back[3] >= 0.0
    same_turn(back, a)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_half_turns_come_back_from_their_matrices(axis):
    half_turn = np.eye(4)[axis]
    same_turn(rot.matrix_to_quat(rot.quat_to_matrix(half_turn)), half_turn)


@untimed
@given(VECTORS)
def test_rotation_vector_is_scipys_and_comes_back(r):
    a = rot.rotation_vector_to_quat(r)
    same_turn(a, Rotation.from_rotvec(r).as_quat())
    np.testing.assert_allclose(rot.quat_to_rotation_vector(a), r, atol=1e-12)
    np.testing.assert_allclose(rot.quat_to_rotation_vector(-a), r, atol=1e-12)


@pytest.mark.parametrize("size", [0.0, 1e-300, 1e-12, 0.9e-6, 1.1e-6])
def test_small_rotation_vectors_are_exact(size):
    r = size * np.array([1.0, -2.0, 2.0]) / 3.0
    a = rot.rotation_vector_to_quat(r)
    np.testing.assert_allclose(a[:3], 0.5 * r, rtol=1e-12)
    np.testing.assert_allclose(rot.quat_to_rotation_vector(a), r, rtol=1e-12)


@untimed
@given(ANGLES, st.floats(-1.5, 1.5), ANGLES)
def test_roll_pitch_yaw_is_the_papers_matrix(roll, pitch, yaw):
    """The matrix of section 2.1 is scipy's ZYX sequence."""
    a = rot.rpy_to_quat(roll, pitch, yaw)
    same_turn(a, Rotation.from_euler("ZYX", [yaw, pitch, roll]).as_quat())
    np.testing.assert_allclose(rot.quat_to_rpy(a), [roll, pitch, yaw], atol=1e-9)


def test_pitch_straight_up_stays_finite():
    found = rot.quat_to_rpy(rot.rpy_to_quat(0.0, np.pi / 2, 0.0))
    assert found[1] == pytest.approx(np.pi / 2, abs=1e-7)


@untimed
@given(VECTORS, VECTORS)
def test_skew_is_the_cross_product(a, b):
    np.testing.assert_allclose(rot.skew(a) @ b, np.cross(a, b), atol=1e-15)
