"""The kernels against an assembly of their own from energies and strips: no line in common."""

import independent_dynamics as independent
import numpy as np
import pytest
from random_vehicles import changed, norm_error, random_motion, random_vehicle

from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import (
    build_model,
    forward_dynamics,
    inverse_dynamics,
    mass_matrix,
    quat_to_matrix,
    restoring_wrench,
)

SIZES = [1, 2, 4, 8, 16, 32]


@pytest.fixture(params=SIZES, ids=lambda n: f"{n} joints")
def wet(request):
    """Joint rates that keep the tip of a long arm within 10 m/s or so."""
    n = request.param
    motion = random_motion(np.random.default_rng(n), n)
    return random_vehicle(300 + n, n), motion._replace(q_dot=motion.q_dot / np.sqrt(n))


def expected_force(vehicle, motion):
    return independent.inverse_dynamics(vehicle, quat_to_matrix(motion.quat), *motion[1:])


def test_the_assemblys_jacobian_is_the_slope_of_its_poses():
    """Omega = R^T R_dot and v = R^T p_dot of the last link under joint rates."""
    vehicle, motion = random_vehicle(1, 5), random_motion(np.random.default_rng(1), 5)
    poses = independent.link_poses(vehicle.arm, motion.q)
    rate = independent.slope(
        lambda q: independent.link_poses(vehicle.arm, q), motion.q, motion.q_dot
    )
    turned = poses[-1, :3, :3].T @ rate[-1, :3, :3]
    along = poses[-1, :3, :3].T @ rate[-1, :3, 3]
    twist = independent.link_jacobian(poses, 4)[:, 6:] @ motion.q_dot
    expected = [*along, turned[2, 1], turned[0, 2], turned[1, 0]]
    np.testing.assert_allclose(twist, expected, rtol=1e-12, atol=1e-13)


def test_mass_matrix_is_the_sum_over_the_bodies(wet):
    vehicle, motion = wet
    found = mass_matrix(build_model(vehicle), motion.q)
    assert norm_error(found, independent.mass_matrix(vehicle, motion.q)) < 1e-11


def test_weight_and_buoyancy_are_the_slope_of_the_potential_energy(wet):
    vehicle, motion = wet
    model, still = build_model(vehicle), np.zeros(vehicle.n_joints)
    rest = inverse_dynamics(model, motion.quat, np.zeros(6), np.zeros(6), motion.q, still, still)
    rotation = quat_to_matrix(motion.quat)
    expected = independent.restoring_force(vehicle, rotation, motion.q)
    assert norm_error(-rest, expected) < 1e-11
    assert norm_error(restoring_wrench(model, motion.quat, motion.q), expected[:6]) < 1e-11


def test_drag_is_the_sum_over_the_strips(wet):
    vehicle, motion = wet
    smooth = build_model(random_vehicle(300 + vehicle.n_joints, vehicle.n_joints, drag=False))
    found = inverse_dynamics(smooth, *motion) - inverse_dynamics(build_model(vehicle), *motion)
    expected = independent.drag_force(vehicle, motion.nu, motion.q, motion.q_dot)
    assert norm_error(found, expected) < 1e-10


@pytest.mark.parametrize("counts", [[9], [9, 0, 3], [0, 0], [0, 17, 1, 0, 8]], ids=str)
def test_drag_of_links_with_any_number_of_cylinders(counts):
    """The kernels take eight cylinders at once, whatever links they belong to."""
    n, rng = len(counts), np.random.default_rng(7)
    data = random_vehicle(70 + n, n).model_dump(mode="json")
    for link, count in zip(data["arm"]["links"], counts, strict=True):
        pieces = [random_vehicle(int(rng.integers(1000)), 1).arm.links[0] for _ in range(count)]
        link["drag"] = [piece.drag[0].model_dump() for piece in pieces]
    vehicle, motion = vehicle_from_data(data), random_motion(rng, n)
    smooth = build_model(changed(vehicle, drag=False))
    found = inverse_dynamics(smooth, *motion) - inverse_dynamics(build_model(vehicle), *motion)
    expected = independent.drag_force(vehicle, motion.nu, motion.q, motion.q_dot)
    assert norm_error(found, expected) < 1e-10


def test_inverse_dynamics_with_all_of_the_water(wet):
    vehicle, motion = wet
    found = inverse_dynamics(build_model(vehicle), *motion)
    assert norm_error(found, expected_force(vehicle, motion)) < 1e-10


def test_forward_dynamics_with_all_of_the_water(wet):
    vehicle, motion = wet
    n = vehicle.n_joints
    tau = np.random.default_rng(n).uniform(-20.0, 20.0, 6 + n)
    rest = motion._replace(nu_dot=np.zeros(6), q_ddot=np.zeros(n))
    matrix = independent.mass_matrix(vehicle, motion.q)
    expected = np.linalg.solve(matrix, tau - expected_force(vehicle, rest))
    found = forward_dynamics(
        build_model(vehicle), motion.quat, motion.nu, motion.q, motion.q_dot, tau
    )
    assert norm_error(found, expected) < 1e-10


def test_inverse_undoes_forward_dynamics_and_forward_inverse(wet):
    vehicle, motion = wet
    model, state = build_model(vehicle), (motion.q, motion.q_dot)
    tau = np.random.default_rng(7).uniform(-20.0, 20.0, 6 + vehicle.n_joints)
    found = forward_dynamics(model, motion.quat, motion.nu, *state, tau)
    again = inverse_dynamics(model, motion.quat, motion.nu, found[:6], *state, found[6:])
    assert norm_error(again, tau) < 1e-10

    force = inverse_dynamics(model, *motion)
    found = forward_dynamics(model, motion.quat, motion.nu, *state, force)
    assert norm_error(found, np.concatenate([motion.nu_dot, motion.q_ddot])) < 1e-10


@pytest.mark.parametrize("times", [1e1, 1e3, 1e5])
def test_forward_dynamics_of_a_plate_whose_water_outweighs_it(times):
    """Added mass so many times the mass, along one slanting axis only: against LAPACK's solve."""
    vehicle, motion = random_vehicle(8, 4), random_motion(np.random.default_rng(8), 4)
    data, normal = vehicle.model_dump(mode="json"), np.array([2.0, -1.0, 2.0]) / 3.0
    added = np.zeros((6, 6))
    added[:3, :3] = times * vehicle.hull.mass_kg * np.outer(normal, normal)
    data["hull"]["added_mass"] = added.tolist()
    model = build_model(vehicle_from_data(data))
    rest = motion._replace(nu_dot=np.zeros(6), q_ddot=np.zeros(4))
    tau = np.linspace(-20.0, 20.0, 10)
    expected = np.linalg.solve(mass_matrix(model, motion.q), tau - inverse_dynamics(model, *rest))
    found = forward_dynamics(model, motion.quat, motion.nu, motion.q, motion.q_dot, tau)
    assert norm_error(found, expected) < 1e-11
