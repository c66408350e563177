"""Every kernel against its numpy reference, on vehicles that share nothing but the schema."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import random_motion, random_vehicle

import uvms_dynamics as kernels
from uvms_dynamics import build_model
from uvms_dynamics.kernels.drag_table import resample
from uvms_dynamics.kernels.rotations import quat_to_matrix
from uvms_dynamics.numpy_reference import body_forces, kinematics, newton_euler

CASES = st.tuples(st.integers(0, 2**32 - 1), st.integers(1, 7))
quick = settings(max_examples=25, deadline=None, derandomize=True)


def case(seed, n):
    vehicle, rng = random_vehicle(seed, n), np.random.default_rng(seed + 1)
    return vehicle, build_model(vehicle), random_motion(rng, n), rng


def relative(motion, current):
    """nu_r and its derivative, from motion over ground in a current."""
    drift = quat_to_matrix(motion.quat).T @ current
    nu_r, nu_r_dot = motion.nu.copy(), motion.nu_dot.copy()
    nu_r[:3] -= drift
    nu_r_dot[:3] += np.cross(motion.nu[3:], drift)
    return nu_r, nu_r_dot


def close(a, b):
    np.testing.assert_allclose(a, b, rtol=1e-10, atol=1e-10 * max(1.0, np.abs(b).max()))


@quick
@given(CASES)
def test_inverse_dynamics_is_the_papers_recursion_in_a_current(seed_and_n):
    vehicle, model, motion, rng = case(*seed_and_n)
    current = rng.normal(size=3)
    joints = (motion.q, motion.q_dot, motion.q_ddot)
    expected = newton_euler.inverse_dynamics(
        vehicle, motion.quat, motion.nu, motion.nu_dot, *joints, current
    )
    close(
        kernels.inverse_dynamics(model, motion.quat, *relative(motion, current), *joints), expected
    )


@quick
@given(CASES)
def test_coupling_wrench_is_the_papers_recursion_in_a_current(seed_and_n):
    vehicle, model, motion, rng = case(*seed_and_n)
    current = rng.normal(size=3)
    joints = (motion.q, motion.q_dot, motion.q_ddot)
    expected = newton_euler.coupling_wrench(
        vehicle, motion.quat, motion.nu, motion.nu_dot, *joints, current
    )
    close(kernels.coupling_wrench(model, *relative(motion, current), *joints), expected)


@quick
@given(CASES)
def test_restoring_wrench(seed_and_n):
    vehicle, model, motion, _ = case(*seed_and_n)
    expected = newton_euler.restoring_wrench(vehicle, motion.quat, motion.q)
    close(kernels.restoring_wrench(model, motion.quat, motion.q), expected)


@quick
@given(CASES)
def test_mass_matrix(seed_and_n):
    vehicle, model, motion, _ = case(*seed_and_n)
    close(kernels.mass_matrix(model, motion.q), newton_euler.mass_matrix(vehicle, motion.q))


@quick
@given(CASES)
def test_mass_matrix_is_symmetric_and_positive_definite(seed_and_n):
    _, model, motion, _ = case(*seed_and_n)
    matrix = kernels.mass_matrix(model, motion.q)
    np.testing.assert_array_equal(matrix, matrix.T)
    assert np.linalg.eigvalsh(matrix)[0] > 0.0


@quick
@given(CASES)
def test_forward_dynamics_is_the_references_solution(seed_and_n):
    vehicle, model, motion, rng = case(*seed_and_n)
    current, tau = rng.normal(size=3), rng.normal(scale=20.0, size=6 + len(motion.q))
    over_ground = newton_euler.forward_dynamics(
        vehicle, motion.quat, motion.nu, motion.q, motion.q_dot, tau, current
    )
    nu_r, shift = relative(motion._replace(nu_dot=np.zeros(6)), current)
    expected = over_ground + np.concatenate([shift, np.zeros(len(motion.q))])
    found = kernels.forward_dynamics(model, motion.quat, nu_r, motion.q, motion.q_dot, tau)
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8 * np.abs(expected).max())


@quick
@given(CASES)
def test_forward_dynamics_undo_inverse_dynamics(seed_and_n):
    _, model, motion, _ = case(*seed_and_n)
    tau = kernels.inverse_dynamics(model, *motion)
    found = kernels.forward_dynamics(model, motion.quat, motion.nu, motion.q, motion.q_dot, tau)
    expected = np.concatenate([motion.nu_dot, motion.q_ddot])
    np.testing.assert_allclose(found, expected, rtol=1e-8, atol=1e-8)


@quick
@given(CASES)
def test_what_the_controller_adds_up_is_the_inverse_dynamics(seed_and_n):
    """M nu_dot + hull bias - restoring - coupling with the vehicle's own acceleration at zero."""
    _, model, motion, _ = case(*seed_and_n)
    quat, nu, nu_dot, q, q_dot, q_ddot = motion
    total = kernels.mass_matrix(model, q)[:6, :6] @ nu_dot
    total += kernels.hull_bias_wrench(model, nu) - kernels.restoring_wrench(model, quat, q)
    total -= kernels.coupling_wrench(model, nu, np.zeros(6), q, q_dot, q_ddot)
    close(total, kernels.inverse_dynamics(model, *motion)[:6])


@quick
@given(CASES)
def test_end_effector_and_its_jacobian(seed_and_n):
    vehicle, model, motion, rng = case(*seed_and_n)
    position = rng.normal(size=3)
    for found, expected in zip(
        kernels.end_effector(model, position, motion.quat, motion.q),
        kinematics.end_effector(vehicle.arm, position, motion.quat, motion.q),
        strict=True,
    ):
        close(found, expected)
    expected = kinematics.end_effector_jacobian(vehicle.arm, motion.quat, motion.q)
    close(kernels.end_effector_jacobian(model, motion.quat, motion.q), expected)


@quick
@given(CASES)
def test_the_jacobian_is_the_slope_of_the_pose(seed_and_n):
    _, model, motion, rng = case(*seed_and_n)
    position, h = rng.normal(size=3), 1e-6
    rotation = quat_to_matrix(motion.quat)

    def pose(t):
        turned = kernels.quat_multiply(
            motion.quat, kernels.rotation_vector_to_quat(t * motion.nu[3:])
        )
        place = position + t * rotation @ motion.nu[:3]
        return kernels.end_effector(model, place, turned, motion.q + t * motion.q_dot)

    (p1, r1), (p0, r0) = pose(h), pose(-h)
    slope = (r1 - r0) @ pose(0.0)[1].T / (2.0 * h)
    twist = np.concatenate([(p1 - p0) / (2.0 * h), [slope[2, 1], slope[0, 2], slope[1, 0]]])
    velocity = np.concatenate([motion.nu, motion.q_dot])
    jacobian = kernels.end_effector_jacobian(model, motion.quat, motion.q)
    np.testing.assert_allclose(jacobian @ velocity, twist, atol=1e-7)


@quick
@given(CASES)
def test_hull_bias_wrench(seed_and_n):
    vehicle, model, motion, _ = case(*seed_and_n)
    still = newton_euler.hull_motion(motion.quat, motion.nu, np.zeros(6), np.zeros(3))
    expected = body_forces.rigid_body(vehicle.hull, still)
    expected += body_forces.added_mass(vehicle.hull, still)
    expected += body_forces.hull_damping(vehicle.hull, motion.nu, vehicle.environment)
    close(kernels.hull_bias_wrench(model, motion.nu), expected)


def test_drag_table_holds_the_files_coefficients():
    coefficient = random_vehicle(0, 1).arm.drag_coefficient
    nodes, values = resample(coefficient)
    reynolds = np.exp(np.linspace(np.log(1.0), np.log(1e6), 10_001))
    exact = np.interp(np.log(reynolds), np.log(coefficient.reynolds), coefficient.cd)
    # 0.1 % within the file's straight pieces; more where one cell bridges a corner of the table
    error = np.abs(np.interp(reynolds, nodes, values) / exact - 1.0)
    assert np.quantile(error, 0.99) < 1e-3
    assert error.max() < 0.03


@pytest.mark.parametrize("speed", [0.0, 1e-12, 1e3])
def test_drag_beyond_the_ends_of_the_table_is_that_of_the_reference(speed):
    vehicle, model, motion, _ = case(5, 2)
    still = motion._replace(
        nu=motion.nu * speed, nu_dot=np.zeros(6), q_dot=np.zeros(2), q_ddot=np.zeros(2)
    )
    expected = newton_euler.inverse_dynamics(vehicle, *still)
    close(kernels.inverse_dynamics(model, *still), expected)
