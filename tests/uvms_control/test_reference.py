"""Interpolation of references: exact at samples, smooth between, at rest outside."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from trajectories import joints, reference, vehicle

from uvms_control.reference import right_jacobian, sample_ahead, sample_reference
from uvms_core.checks import check
from uvms_core.errors import SignalError
from uvms_core.signals import to_nanoseconds
from uvms_dynamics.kernels.rotations import quat_to_matrix, rotation_vector_to_quat, skew

TIMES = np.linspace(0.0, 0.5, 6)
JOINT_NAMES = ("a", "b", "c", "d")
STAMP = 3_000_000_000


def test_every_sample_comes_back_exactly():
    planned = reference(TIMES, STAMP)
    for i, t in enumerate(TIMES):
        found = sample_reference(planned, STAMP + to_nanoseconds(t))
        for name in vars(found):
            assert np.array_equal(getattr(found, name), getattr(planned, name)[i])


@settings(deadline=None)
@given(t=st.floats(0.0, 0.5))
def test_between_samples_the_motion_is_followed_closely(t):
    found = sample_reference(reference(TIMES, STAMP), STAMP + to_nanoseconds(t))
    position, quaternion, nu, nu_dot = vehicle(t)
    q, q_dot, q_ddot = joints(t)
    assert np.allclose(found.position, position, atol=2e-6)
    assert np.allclose(quat_to_matrix(found.quaternion), quat_to_matrix(quaternion), atol=2e-6)
    assert np.allclose(found.nu, nu, atol=1e-4)
    assert np.allclose(found.nu_dot, nu_dot, atol=2e-3)
    assert np.allclose(found.q, q, atol=2e-6)
    assert np.allclose(found.q_dot, q_dot, atol=1e-4)
    assert np.allclose(found.q_ddot, q_ddot, atol=2e-3)


@settings(deadline=None)
@given(t=st.floats(0.01, 0.49))
def test_velocities_are_the_derivatives_of_the_interpolated_poses(t):
    planned = reference([0.0, 0.5], STAMP)
    h = 1e-5
    at, before, after = (
        sample_reference(planned, STAMP + to_nanoseconds(x)) for x in (t, t - h, t + h)
    )
    R = quat_to_matrix(at.quaternion)
    R_dot = (quat_to_matrix(after.quaternion) - quat_to_matrix(before.quaternion)) / (2 * h)
    assert np.allclose(R.T @ R_dot, skew(at.nu[3:]), atol=1e-6)
    assert np.allclose(R @ at.nu[:3], (after.position - before.position) / (2 * h), atol=1e-6)
    assert np.allclose(at.q_dot, (after.q - before.q) / (2 * h), atol=1e-6)


def test_the_end_is_in_motion_and_beyond_it_everything_rests():
    planned = reference(TIMES, STAMP)
    assert np.array_equal(sample_reference(planned, planned.end).nu, planned.nu[-1])
    after = sample_reference(planned, planned.end + 1)
    assert np.array_equal(after.position, planned.position[-1])
    assert np.array_equal(after.q, planned.q[-1])
    for name in ("nu", "nu_dot", "q_dot", "q_ddot"):
        assert not getattr(after, name).any()
    before = sample_reference(planned, STAMP - 1)
    assert np.array_equal(before.quaternion, planned.quaternion[0])
    assert not before.nu.any()
    assert not before.q_dot.any()


def test_what_is_ahead_is_the_plan_at_that_instant_and_goes_on_beyond_its_end():
    planned = reference(TIMES, STAMP)
    lead = 150_000_000
    for t in (0.0, 0.1, 0.17, 0.35):  # at samples and between, up to the last
        found = sample_ahead(planned, STAMP + to_nanoseconds(t), lead)
        expected = sample_reference(planned, STAMP + to_nanoseconds(t) + lead)
        for name in vars(found):
            assert np.array_equal(getattr(found, name), getattr(expected, name)), name
    beyond = sample_ahead(planned, STAMP + to_nanoseconds(0.45), lead)
    assert np.allclose(beyond.q, planned.q[-1] + 0.1 * planned.q_dot[-1], rtol=1e-12)
    assert np.array_equal(beyond.nu_dot, planned.nu_dot[-1])
    assert np.array_equal(beyond.q_dot, planned.q_dot[-1])
    before = sample_ahead(planned, STAMP - to_nanoseconds(1.0), lead)
    assert np.array_equal(before.q, planned.q[0])


def test_a_single_sample_holds():
    held = reference([0.0], STAMP)
    assert np.array_equal(sample_reference(held, STAMP).q, held.q[0])
    assert not sample_reference(held, STAMP + 1).q_dot.any()


@settings(deadline=None)
@given(phi=st.lists(st.floats(-1.5, 1.5), min_size=3, max_size=3).map(np.array))
def test_right_jacobian_maps_rotation_vector_rates_to_body_rates(phi):
    rate, h = np.array([0.3, -0.7, 0.5]), 1e-6
    R, ahead, behind = (
        quat_to_matrix(rotation_vector_to_quat(phi + k * h * rate)) for k in (0, 1, -1)
    )
    omega = R.T @ (ahead - behind) / (2 * h)
    assert np.allclose(omega, skew(right_jacobian(phi) @ rate), atol=1e-8)


def test_both_quaternion_signs_give_the_same_motion():
    planned = reference(TIMES, STAMP)
    signs = np.array([1.0, -1.0, 1.0, -1.0, -1.0, 1.0])[:, None]
    flipped = replace(planned, quaternion=signs * planned.quaternion)
    for t in (0.03, 0.17, 0.333):
        one = sample_reference(planned, STAMP + to_nanoseconds(t))
        two = sample_reference(flipped, STAMP + to_nanoseconds(t))
        assert np.allclose(one.nu, two.nu, atol=1e-12)
        R = quat_to_matrix(two.quaternion)
        assert np.allclose(quat_to_matrix(one.quaternion), R, atol=1e-12)


def test_bad_references_are_named():
    good = reference(TIMES)
    check("reference", good, n=JOINT_NAMES)
    bad = good.q.copy()
    bad[2, 1] = np.nan
    cases = [
        (replace(good, q=bad), "reference.q[2, b] is nan; it must be finite"),
        (replace(good, nu=good.nu[:4]), "reference.nu has shape (4, 6); it must have (6, 6)"),
        (
            replace(good, quaternion=2.0 * good.quaternion),
            "reference.quaternion[0] has length 2; it must be 1",
        ),
        (
            replace(good, times=np.empty(0)),
            "reference.times has shape (0,); it must have (k,), k >= 1",
        ),
        (
            replace(good, times=-good.times),
            f"reference.times is {-good.times}; it must increase from 0",
        ),
    ]
    for wrong, message in cases:
        with pytest.raises(SignalError) as error:
            check("reference", wrong, n=JOINT_NAMES)
        assert str(error.value) == message
    for each in (good, replace(good)):  # already checked, and not yet
        with pytest.raises(
            SignalError, match=r"reference.q has .*; it must have \(6, 3\) for a, b"
        ):
            check("reference", each, n=JOINT_NAMES[:3])
