"""Only the motion relative to the water counts; the truth holds what the current does."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import REFERENCE, norm_error, random_motion, random_vehicle

from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics import (
    build_model,
    hull_bias_wrench,
    inverse_dynamics,
    quat_to_matrix,
    thruster_matrix,
)
from uvms_dynamics.kernels.ambient import CURRENT_SIGMA, water_wrenches
from uvms_dynamics.numpy_reference import body_inertia, newton_euler
from uvms_dynamics.simulation import Plant, PlantConfig

CURRENT = np.array([0.3, -0.2, 0.0])
CASES = st.tuples(st.integers(0, 2**32 - 1), st.sampled_from([1, 3, 6]))


@settings(max_examples=25, deadline=None, derandomize=True)
@given(CASES)
def test_the_same_relative_flow_gives_the_same_force(seed_and_n):
    """Over ground in any current, by the numpy reference: the kernel's force for the flow alone."""
    seed, n = seed_and_n
    vehicle, rng = random_vehicle(seed, n), np.random.default_rng(seed)
    quat, nu_r, nu_r_dot, *joints = random_motion(rng, n)
    expected = inverse_dynamics(build_model(vehicle), quat, nu_r, nu_r_dot, *joints)
    for current in rng.uniform(-3.0, 3.0, (3, 3)):
        drift = quat_to_matrix(quat).T @ current
        nu, nu_dot = nu_r.copy(), nu_r_dot.copy()
        nu[:3] += drift
        nu_dot[:3] -= np.cross(nu_r[3:], drift)
        found = newton_euler.inverse_dynamics(vehicle, quat, nu, nu_dot, *joints, current)
        assert norm_error(found, expected) < 1e-10


def run_in_current(current, nu, steps=40):
    """True odometry and joints after 2 s in a current, with thrust and torque."""
    config = PlantConfig(
        current_ned_m_s=tuple(map(float, current)),
        initial_velocity=tuple(map(float, nu)),
        initial_rpy_deg=(10.0, -20.0, 60.0),
        initial_joints_deg=(20.0, 30.0, 40.0, 50.0),
    )
    plant = Plant(REFERENCE, config, seed=1)
    thrust = ThrusterCommand(0, np.array([50.0, 10.0, -10.0, 5.0, -5.0, 8.0, 3.0]))
    effort = JointCommand(0, np.array([3.0, 4.0, 2.0, 0.5]))
    for _ in range(steps):
        plant.step(thrust, effort)
    return plant.truth()


@pytest.mark.parametrize(
    "current", [CURRENT, np.array([-1.0, 2.0, 0.5]), np.array([3.0, 0.0, -0.2])]
)
def test_at_rest_in_moving_water_is_moving_through_still_water(current):
    rotation = quat_to_matrix(
        Plant(REFERENCE, PlantConfig(initial_rpy_deg=(10.0, -20.0, 60.0)), 1)
        .truth()
        .odometry.quaternion
    )
    against = np.concatenate([-rotation.T @ current, np.zeros(3)])
    carried = run_in_current(current, np.zeros(6))
    driven = run_in_current(np.zeros(3), against)
    shift = carried.odometry.position - driven.odometry.position
    np.testing.assert_allclose(shift, 2.0 * current, atol=1e-10)
    np.testing.assert_allclose(carried.odometry.quaternion, driven.odometry.quaternion, atol=1e-10)
    np.testing.assert_allclose(carried.joints.position, driven.joints.position, atol=1e-10)
    np.testing.assert_allclose(carried.disturbance.coupling, driven.disturbance.coupling, atol=1e-8)


def test_truth_says_what_the_current_does_to_the_hull():
    """At rest and level in a current along x: the hull's own surge resistance."""
    data = REFERENCE.model_dump(mode="json")
    for link in data["arm"]["links"]:  # an arm that weighs nothing to speak of
        link.update(mass_kg=1e-9, volume_m3=1e-12, inertia_kg_m2=[1e-12] * 3, drag=[])
        link["added_mass"] = [0.0] * 6
    data["hull"]["fins"] = []  # they are set at an angle
    data["hull"].update(mass_kg=1025.0 * data["hull"]["volume_m3"], cg_m=[0.0, 0.0, 0.01])
    vehicle = vehicle_from_data(data)
    plant = Plant(vehicle, PlantConfig(current_ned_m_s=(0.5, 0.0, 0.0)), seed=1)
    truth = plant.truth()
    drag = 4.49 * 0.5 + 8.12 * 0.5**2
    np.testing.assert_allclose(truth.disturbance.external[0], drag, rtol=1e-6)
    np.testing.assert_allclose(truth.disturbance.external[1:], 0.0, atol=1e-9)
    np.testing.assert_allclose(truth.odometry.nu, 0.0, atol=1e-15)
    np.testing.assert_allclose(truth.disturbance.restoring, 0.0, atol=1e-6)


def test_no_external_disturbance_in_still_water():
    plant = Plant(REFERENCE, PlantConfig(initial_velocity=(0.5, 0.1, 0, 0, 0.1, 0.2)), seed=1)
    plant.step(None, None)
    np.testing.assert_array_equal(plant.truth().disturbance.external, np.zeros(6))


def test_truth_budget_explains_the_hulls_motion():
    """M_hull nu_dot + bias of the hull = restoring + coupling + external + thrust, in a current.

    The acceleration comes from two neighbouring ticks, not from the plant's own equations.
    """
    model, step = build_model(REFERENCE), 1e-4
    config = PlantConfig(
        step_s=step,
        control_period_s=step,
        initial_velocity=(0.5, 0.1, 0.0, 0.0, 0.1, 0.2),
        current_ned_m_s=tuple(CURRENT),
    )
    plant = Plant(sensors_at(REFERENCE, 1.0), config, seed=1)
    command = ThrusterCommand(0, np.zeros(REFERENCE.n_thrusters))
    command.thrust[0] = 30.0
    truths = []
    for _ in range(40):
        plant.step(command, None)
        truths.append(plant.truth())
    before, now, after = truths[-3:]
    nu = now.odometry.nu
    nu_dot = (after.odometry.nu - before.odometry.nu) / (2.0 * step)
    needed = body_inertia(REFERENCE.hull) @ nu_dot + hull_bias_wrench(model, nu)
    budget = now.disturbance
    given = budget.restoring + budget.coupling + budget.external
    given += thruster_matrix(REFERENCE) @ now.thrust
    np.testing.assert_allclose(given, needed, atol=1e-4 * np.abs(needed).max())


def sensors_at(vehicle, rate):
    """The vehicle with all sensors at one rate, Hz."""
    data = vehicle.model_dump(mode="json")
    for name in ("imu", "dvl", "pressure", "gps"):
        data["sensors"][name]["rate_hz"] = rate
    return vehicle_from_data(data)


@settings(max_examples=25, deadline=None, derandomize=True)
@given(CASES)
def test_what_a_current_adds_is_the_difference_between_two_flows(seed_and_n):
    """By the numpy reference, over ground: forces needed in a current and against it, halved."""
    seed, n = seed_and_n
    vehicle, rng = random_vehicle(seed, n), np.random.default_rng(seed)
    quat, nu, nu_dot, *joints = random_motion(rng, n)
    found = water_wrenches(build_model(vehicle), quat, nu, *joints[:2])
    for k, current in enumerate(CURRENT_SIGMA * np.eye(3)):
        to, fro = (
            newton_euler.inverse_dynamics(vehicle, quat, nu, nu_dot, *joints, each)[:6]
            for each in (current, -current)
        )
        np.testing.assert_allclose(found[:, k], 0.5 * (fro - to), atol=1e-9 * np.abs(to).max())


def test_at_rest_a_current_is_all_that_the_water_may_have_done():
    wrenches = water_wrenches(
        build_model(REFERENCE), np.array([0.0, 0.0, 0.0, 1.0]), np.zeros(6), *np.zeros((2, 4))
    )
    assert (np.abs(wrenches[np.arange(3), np.arange(3)]) > 1.0).all()
    assert (wrenches[np.arange(3), np.arange(3)] > 0.0).all()  # along with the flow
    assert (wrenches[:, 3] == 0.0).all()
