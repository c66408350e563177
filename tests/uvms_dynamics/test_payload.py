"""A payload in the gripper: its weight, its inertia, and the momentum when it is grasped."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.errors import ConfigError
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.frames import arm_frames, compose, joint_frames, mounting_pose
from uvms_core.vehicle.statics import joint_loads
from uvms_dynamics.kernels import mass_matrix
from uvms_dynamics.kernels.rotations import quat_to_matrix, rotation_vector_to_quat
from uvms_dynamics.model import build_model
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.events import Load, loaded
from uvms_dynamics.simulation.events.payload import PayloadEvent

N, M = REFERENCE.n_joints, REFERENCE.n_thrusters
RHO, G = 1025.0, 9.81
LOAD = Load(
    mass_kg=1.02, volume_m3=0.0005, at_m=(0.02, -0.01, 0.1), inertia_kg_m2=(0.01, 0.02, 0.025)
)
Q = np.radians([20.0, 30.0, 60.0, 25.0])
VACUUM = {
    "environment.gravity_m_s2": 1e-9,
    "environment.water_density_kg_m3": 1e-9,
    "hull.mass_kg": 184.0,
    "hull.cg_m": [0.0, 0.0, 0.012],
    "hull.added_mass": [0.0] * 6,
    "hull.linear_damping": [0.0] * 6,
    "hull.quadratic_damping": [0.0] * 6,
} | {f"arm.links.{i}.added_mass": [0.0] * 6 for i in range(N)}


def place_of(vehicle, q, load=LOAD):
    """Centre of the load and the tool's axes in the body frame."""
    origin, rotation = arm_frames(vehicle.arm, q)[-1]
    origin, rotation = compose((origin, rotation), mounting_pose(vehicle.arm.tool))
    return origin + rotation @ load.at_m, rotation


def still(plant, effort=None):
    effort = np.zeros(N) if effort is None else effort
    plant.step(ThrusterCommand(plant.stamp, np.zeros(M)), JointCommand(plant.stamp, effort))


def test_its_weight_in_water_is_felt_at_its_place():
    """W = m g - rho V g down, p x W about the body origin."""
    config = PlantConfig(initial_joints_deg=tuple(np.degrees(Q)))
    bare = Plant(REFERENCE, config, 1).truth().disturbance.restoring
    events = (PayloadEvent(at_s=0.0, payload=LOAD),)
    felt = Plant(REFERENCE, config, 1, events).truth().disturbance.restoring - bare
    force = np.array([0.0, 0.0, (LOAD.mass_kg - RHO * LOAD.volume_m3) * G])
    place, _ = place_of(REFERENCE, Q)
    np.testing.assert_allclose(felt, [*force, *np.cross(place, force)], rtol=1e-9, atol=1e-9)


def test_joints_carry_it_and_hold_still_under_the_torque_of_its_weight():
    """Static equilibrium of an arm on a hull that is too heavy to move."""
    heavy = load_vehicle(None, {"hull.inertia_kg_m2": [50.0, 300.0, 300.0]})
    config = PlantConfig(initial_joints_deg=tuple(np.degrees(Q)))
    plant = Plant(heavy, config, 1, (PayloadEvent(at_s=0.0, payload=LOAD),))
    own, place = joint_loads(heavy, Q), place_of(heavy, Q)[0]
    force = np.array([0.0, 0.0, (LOAD.mass_kg - RHO * LOAD.volume_m3) * G])
    poses = [(o, r[:, 2]) for o, r in joint_frames(heavy.arm, Q)]
    extra = [axis @ np.cross(place - origin, force) for origin, axis in poses]
    free = Plant(heavy, config, 1, (PayloadEvent(at_s=0.0, payload=LOAD),))
    for _ in range(4):
        still(plant, -(own + extra))
        still(free, -own)
    held, fallen = plant.truth().joints.position, free.truth().joints.position
    # What is left is the hull, which is not fixed and sinks and pitches under the weight.
    assert np.abs(held - Q).max() < 0.15 * np.abs(fallen - Q).max()
    assert np.abs(fallen - Q).max() > 0.01


def test_its_inertia_is_that_of_the_body_that_it_is():
    """M_after - M_before = J^T diag((m + m_A) E, I) J, J by differences of the load's pose."""
    added = 0.5 * RHO * LOAD.volume_m3
    jacobian = np.zeros((6, 6 + N))
    step = 1e-6
    for k in range(6 + N):
        ends = [_pose(sign * step * np.eye(6 + N)[k]) for sign in (1.0, -1.0)]
        jacobian[:3, k] = (ends[0][0] - ends[1][0]) / (2.0 * step)
        turn = (ends[0][1] - ends[1][1]) @ _pose(np.zeros(6 + N))[1].T / (2.0 * step)
        jacobian[3:, k] = turn[2, 1], turn[0, 2], turn[1, 0]
    _, axes = place_of(REFERENCE, Q)
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = (LOAD.mass_kg + added) * np.eye(3)
    inertia[3:, 3:] = axes @ LOAD.own_inertia @ axes.T
    before = mass_matrix(build_model(REFERENCE), Q)
    after = mass_matrix(build_model(loaded(REFERENCE, LOAD)), Q)
    np.testing.assert_allclose(after - before, jacobian.T @ inertia @ jacobian, atol=1e-7)


def _pose(change):
    """The load's centre and axes after small motions (6+n,) of hull and joints."""
    turn = quat_to_matrix(rotation_vector_to_quat(change[3:6]))
    place, axes = place_of(REFERENCE, Q + change[6:])
    return change[:3] + turn @ place, turn @ axes


def test_a_sphere_is_the_default():
    load = Load(mass_kg=2.0, volume_m3=4.0 / 3.0 * np.pi * 0.1**3)
    np.testing.assert_allclose(load.own_inertia, 0.4 * 2.0 * 0.1**2 * np.eye(3))


def centre_of_mass(vehicle, plant, load=None):
    truth = plant.truth()
    q, rotation = truth.joints.position, quat_to_matrix(truth.odometry.quaternion)
    poses = [(np.zeros(3), np.eye(3)), *arm_frames(vehicle.arm, q)[1:]]
    bodies = [
        (body.mass_kg, origin + axes @ body.cg_m)
        for body, (origin, axes) in zip((vehicle.hull, *vehicle.arm.links), poses, strict=True)
    ]
    if load is not None:
        bodies.append((load.mass_kg, place_of(vehicle, q, load)[0]))
    total = sum(mass for mass, _ in bodies)
    return total, truth.odometry.position + rotation @ sum(m * p for m, p in bodies) / total


def test_momentum_is_conserved_when_a_resting_load_is_grasped():
    """Free bodies without water or weight: (M + m) V_after = M V_before for the centre of mass."""
    vehicle, load = load_vehicle(None, VACUUM), Load(mass_kg=20.0, volume_m3=0.0)
    config = PlantConfig(
        initial_joints_deg=tuple(np.degrees(Q)), initial_velocity=(0.4, -0.1, 0.2, 0.0, 0.1, 0.05)
    )
    plant = Plant(vehicle, config, 1, (PayloadEvent(at_s=1.0, payload=load),))
    places, masses = [], []
    for k in range(40):
        mass, place = centre_of_mass(vehicle, plant, load if k > 20 else None)
        places.append(place)
        masses.append(mass)
        still(plant)
    before, after = np.diff(places[:20], axis=0), np.diff(places[21:], axis=0)
    assert np.ptp(before, axis=0).max() < 1e-7
    assert np.ptp(after, axis=0).max() < 1e-7
    np.testing.assert_allclose(masses[-1] * after[0], masses[0] * before[0], atol=1e-5)


def test_nothing_jumps_when_it_is_released():
    events = (
        PayloadEvent(at_s=0.0, payload=LOAD),
        PayloadEvent(at_s=0.5, payload="release"),
    )
    config = PlantConfig(initial_velocity=(0.3, 0.0, 0.1, 0.0, 0.0, 0.1))
    released = Plant(REFERENCE, config, 1, events)
    held = Plant(REFERENCE, config, 1, events[:1])
    for _ in range(10):
        still(released)
        still(held)
    np.testing.assert_array_equal(released.truth().odometry.nu, held.truth().odometry.nu)
    for _ in range(10):
        still(released)
        still(held)
    assert np.abs(released.truth().odometry.nu - held.truth().odometry.nu).max() > 1e-3


def test_it_moves_with_the_water_of_the_vehicle_in_a_current():
    """A load on the ground is at rest over ground: a vehicle at rest over ground does not jump."""
    config = PlantConfig(current_ned_m_s=(0.3, 0.1, 0.0))
    plant = Plant(REFERENCE, config, 1, (PayloadEvent(at_s=0.0, payload=LOAD),))
    np.testing.assert_allclose(plant.truth().odometry.nu, 0.0, atol=1e-12)


def test_a_second_grasp_and_a_release_of_nothing_are_refused():
    for events in (
        (PayloadEvent(at_s=0.0, payload=LOAD), PayloadEvent(at_s=1.0, payload=LOAD)),
        (PayloadEvent(at_s=1.0, payload="release"),),
    ):
        with pytest.raises(ConfigError, match="payload at 1 s: the arm holds"):
            Plant(REFERENCE, PlantConfig(), 1, events)
