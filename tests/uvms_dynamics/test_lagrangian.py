"""Rigid and added mass with all their Coriolis terms, from the kinetic energy alone.

The mass matrix is summed from the bodies' Jacobians, and the equations of motion are those of Euler
and Poincare (vehicle) and of Lagrange (joints), with the slopes of M(q) by finite differences: no
line of the recursion is used.
"""

import numpy as np
import pytest
from random_vehicles import random_motion, random_vehicle

from uvms_dynamics import build_model, inverse_dynamics, mass_matrix, restoring_wrench
from uvms_dynamics.rotations import skew
from uvms_dynamics.vehicle.frames import arm_frames
from uvms_dynamics.vehicle.shapes import move_to_origin


def body_inertia(body):
    """Rigid and added mass (6, 6) about the body frame's origin."""
    rigid = move_to_origin(
        body.mass_kg * np.eye(3), np.array(body.inertia_kg_m2), np.array(body.cg_m)
    )
    return rigid + np.array(body.added_mass)


def link_jacobian(frames, i):
    """Twist (6,) of link i in its own frame, from (nu, q_dot)."""
    origin, rotation = frames[i + 1]
    jacobian = np.zeros((6, 6 + len(frames) - 1))
    jacobian[:3, :3] = np.eye(3)
    jacobian[:3, 3:6] = -skew(origin)
    jacobian[3:, 3:6] = np.eye(3)
    for j in range(i + 1):
        axis = frames[j][1][:, 2]
        jacobian[:3, 6 + j] = np.cross(axis, origin - frames[j][0])
        jacobian[3:, 6 + j] = axis
    return np.kron(np.eye(2), rotation.T) @ jacobian


def summed_mass_matrix(vehicle, q):
    """sum J^T M J over the bodies, and the rotors."""
    n = vehicle.n_joints
    matrix = np.zeros((6 + n, 6 + n))
    matrix[:6, :6] = body_inertia(vehicle.hull)
    matrix[6:, 6:] = np.diag([joint.rotor_inertia_kg_m2 for joint in vehicle.arm.joints])
    frames = arm_frames(vehicle.arm, q)
    for i, link in enumerate(vehicle.arm.links):
        jacobian = link_jacobian(frames, i)
        matrix += jacobian.T @ body_inertia(link) @ jacobian
    return matrix


def slopes(vehicle, q, h=1e-4):
    """dM/dq (n, 6+n, 6+n), fourth order."""
    result = []
    for unit in h * np.eye(len(q)):
        m = [summed_mass_matrix(vehicle, q + k * unit) for k in (-2, -1, 1, 2)]
        result.append((m[0] - 8.0 * m[1] + 8.0 * m[2] - m[3]) / (12.0 * h))
    return np.array(result)


@pytest.mark.parametrize(("seed", "n"), [(1, 1), (2, 2), (3, 4), (4, 7)])
def test_mass_matrix_is_the_sum_over_the_bodies(seed, n):
    vehicle = random_vehicle(seed, n)
    q = np.random.default_rng(seed).uniform(-3.0, 3.0, n)
    found = mass_matrix(build_model(vehicle), q)
    np.testing.assert_allclose(found, summed_mass_matrix(vehicle, q), rtol=1e-11, atol=1e-11)


@pytest.mark.parametrize(("seed", "n"), [(1, 1), (2, 2), (3, 4), (4, 7)])
def test_coriolis_terms_follow_from_the_kinetic_energy(seed, n):
    vehicle = random_vehicle(seed, n, drag=False)
    model = build_model(vehicle)
    motion = random_motion(np.random.default_rng(seed), n)
    velocity = np.concatenate([motion.nu, motion.q_dot])
    acceleration = np.concatenate([motion.nu_dot, motion.q_ddot])

    matrix, slope = summed_mass_matrix(vehicle, motion.q), slopes(vehicle, motion.q)
    momentum = matrix @ velocity
    expected = matrix @ acceleration + np.tensordot(motion.q_dot, slope, 1) @ velocity
    expected[6:] -= 0.5 * np.einsum("i,kij,j->k", velocity, slope, velocity)
    v, w = motion.nu[:3], motion.nu[3:]
    expected[:3] += np.cross(w, momentum[:3])
    expected[3:6] += np.cross(w, momentum[3:6]) + np.cross(v, momentum[:3])

    still = np.zeros(n)
    weight = inverse_dynamics(model, motion.quat, np.zeros(6), np.zeros(6), motion.q, still, still)
    np.testing.assert_allclose(
        weight[:6], -restoring_wrench(model, motion.quat, motion.q), rtol=1e-12, atol=1e-9
    )
    found = inverse_dynamics(model, *motion) - weight
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-7 * np.abs(expected).max())
