"""The tether in the plant, against static equilibrium and an attachment of the same weight."""

import numpy as np
import pytest
from random_vehicles import random_vehicle
from urdf_chains import real_vehicle

from uvms_core.vehicle import vehicle_from_data
from uvms_core.vehicle.frames import arm_frames
from uvms_dynamics import build_model, inverse_dynamics, quat_to_matrix, restoring_wrench
from uvms_dynamics.simulation import Plant, PlantConfig, make_state, make_system, simulate
from uvms_dynamics.simulation.integrator import VELOCITY

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def tethered(vehicle, depth=0.0, weight=0.0, moment=(0.0, 0.0, 0.0)):
    data = vehicle.model_dump(mode="json")
    data["tether"] = {
        "reference_depth_m": depth,
        "weight_per_m_n": weight,
        "moment_per_m_nm": list(moment),
    }
    return vehicle_from_data(data)


def without_tether(vehicle):
    return vehicle.model_copy(update={"tether": None})


def held(vehicle, start, seconds, step=0.01):
    """States of the vehicle, whose joints friction and stops hold, without commands."""
    system = make_system(vehicle)
    idle = np.zeros(vehicle.n_thrusters), np.zeros(vehicle.n_joints)
    return simulate(system, start, *idle, step, round(seconds / step))


def stiff(vehicle):
    """The arm as good as locked: it must not sag while the vehicle finds its rest."""
    data = vehicle.model_dump(mode="json")
    for joint in data["arm"]["joints"]:
        joint.update(viscous_friction_nm_s=1e4, rotor_inertia_kg_m2=1e3)
    return vehicle_from_data(data)


def wet_weight(vehicle):
    sea = vehicle.environment
    bodies = [vehicle.hull, *vehicle.arm.links]
    masses = [body.mass_kg - sea.water_density_kg_m3 * body.volume_m3 for body in bodies]
    return sea.gravity_m_s2 * sum(masses)


def test_a_floating_vehicle_sinks_or_rises_to_where_the_tether_balances_its_weight():
    """w (d - d0) + W = 0: the depth of rest, whatever the start; W < 0 floats."""
    vehicle = stiff(real_vehicle(**{"hull.volume_m3": 0.0135}))
    roped = tethered(vehicle, depth=2.0, weight=-8.0)
    rest = 2.0 + wet_weight(vehicle) / 8.0
    assert wet_weight(vehicle) < -3.0
    assert 1.0 < rest < 2.0
    q = np.radians(vehicle.arm.stowed_deg)
    for depth in (1.0, 4.0):
        start = make_state(q, vehicle.n_thrusters, position=(0.0, 0.0, depth))
        assert held(roped, start, 120.0)[-1, 2] == pytest.approx(rest, abs=1e-3)


def test_its_moment_turns_the_vehicle_to_where_all_moments_balance():
    """At rest k, down in body axes, is along the sum of the first moments: m_0 + m (d - d0)."""
    changes = {"hull.mass_kg": "neutral", "hull.linear_damping": [20.0] * 3 + [2.0] * 3}
    vehicle = stiff(without_tether(real_vehicle(**changes)))
    moment, depth, d0 = np.array([0.4, -0.2, 0.1]), 5.0, 3.0
    roped = tethered(vehicle, depth=d0, moment=moment)
    q = np.radians(vehicle.arm.stowed_deg)
    start = make_state(q, vehicle.n_thrusters, position=(0.0, 0.0, depth))
    end = held(roped, start, 60.0)[-1]
    own = first_moment(vehicle, q)
    total = own + moment * (end[2] - d0)
    down = quat_to_matrix(end[3:7])[2]
    assert np.abs(end[VELOCITY + 3 : VELOCITY + 6]).max() < 1e-4
    np.testing.assert_allclose(down, total / np.linalg.norm(total), atol=2e-3)
    assert np.degrees(np.arccos(down @ own / np.linalg.norm(own))) > 3.0


def first_moment(vehicle, q):
    """Sum of position times weight less buoyancy (3,), from the frames of the vehicle file."""
    sea = vehicle.environment
    poses = [(np.zeros(3), np.eye(3)), *arm_frames(vehicle.arm, q)[1:]]
    total = np.zeros(3)
    for body, (origin, rotation) in zip([vehicle.hull, *vehicle.arm.links], poses, strict=True):
        total += body.mass_kg * (origin + rotation @ body.cg_m)
        total -= sea.water_density_kg_m3 * body.volume_m3 * (origin + rotation @ body.cb_m)
    return sea.gravity_m_s2 * total


@pytest.mark.parametrize(("seed", "n"), [(71, 1), (72, 5)])
def test_at_one_depth_it_is_an_attachment_of_its_weight(seed, n):
    """The first acceleration, in any attitude: lead of 7 N at r, or w = 3.5 N/m, m = w r, 2 m."""
    vehicle, place = random_vehicle(seed, n), np.array([0.3, -0.2, 0.4])
    data = vehicle.model_dump(mode="json")
    data["hull"]["attachments"] = [
        {"name": "lead", "position_m": place.tolist(), "wet_weight_n": 7.0}
    ]
    roped = tethered(vehicle, depth=1.0, weight=3.5, moment=3.5 * place)
    quat = np.array([0.3, -0.5, 0.1, 0.8]) / np.linalg.norm([0.3, -0.5, 0.1, 0.8])
    q, depth = np.linspace(-1.0, 1.0, n), (0.0, 0.0, 3.0)
    start = make_state(q, vehicle.n_thrusters, position=depth, quat=quat)
    found, expected = (
        held(each, start, 2e-6, 1e-6)[-1] for each in (roped, vehicle_from_data(data))
    )
    change, reference = found - start, expected - start
    np.testing.assert_allclose(change[7:], reference[7:], rtol=1e-5, atol=1e-15)


def test_a_tether_of_no_weight_changes_not_one_bit():
    vehicle = without_tether(real_vehicle())
    start = make_state(np.radians(vehicle.arm.stowed_deg), vehicle.n_thrusters, position=(0, 0, 5))
    plain, roped = (held(each, start, 5.0) for each in (vehicle, tethered(vehicle, depth=1.0)))
    assert np.array_equal(plain, roped)


@pytest.mark.parametrize(("depth", "below"), [(1.0, 0.4), (4.6, 0.6), (0.0, -0.6)])
def test_the_plant_of_the_real_vehicle_feels_it_and_reports_it_as_external(depth, below):
    """In proportion to the depth below 0.6 m, and cut 0.6 m from there."""
    vehicle, config = real_vehicle(), PlantConfig(initial_position_m=(0.0, 0.0, depth))
    truth = Plant(vehicle, config, seed=1).truth()
    expected = np.zeros(6)  # 0.0559 N m/m forward: bow down below the reference depth
    expected[3:] = np.cross([0.0559 * below, 0.0, 0.0], [0.0, 0.0, 1.0])
    np.testing.assert_allclose(truth.disturbance.external, expected, atol=1e-12)
    plain = Plant(without_tether(vehicle), config, seed=1).truth()
    np.testing.assert_array_equal(plain.disturbance.external, np.zeros(6))
    np.testing.assert_array_equal(plain.disturbance.restoring, truth.disturbance.restoring)


def test_models_of_the_controllers_do_not_know_it():
    vehicle = random_vehicle(73, 3)
    roped = tethered(vehicle, weight=100.0, moment=(50.0, 0.0, 0.0))
    q = np.zeros(3)
    for function, arguments in (
        (restoring_wrench, (LEVEL, q)),
        (inverse_dynamics, (LEVEL, np.ones(6), np.ones(6), q, q, q)),
    ):
        expected = function(build_model(vehicle), *arguments)
        np.testing.assert_array_equal(function(build_model(roped), *arguments), expected)
