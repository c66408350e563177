"""Vehicle files that are copies of others: their physics by similarity, and what is refused."""

import re

import numpy as np
import pytest
import yaml
from random_vehicles import REFERENCE
from scaled_vehicles import by_mass

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import dump_vehicle, load_vehicle, vehicle_from_data, vehicle_from_yaml
from uvms_core.vehicle.locate import known_vehicles
from uvms_core.vehicle.scaled import scaled_data
from uvms_dynamics import build_model, restoring_wrench
from uvms_dynamics.kernels.hull import hull_hydrodynamic_wrench

MASSES = {"reference_auv_heavy": 10.0, "reference_auv_light": 0.1}


def wrench_scale(length, force):
    return np.repeat([length**force, length ** (force + 1)], 3)


@pytest.mark.parametrize("name", MASSES)
def test_the_copy_has_the_mass_and_the_densities(name):
    copy, factor = load_vehicle(name), MASSES[name]
    assert copy.hull.mass_kg == pytest.approx(factor * REFERENCE.hull.mass_kg, rel=1e-12)
    assert copy.hull.volume_m3 == pytest.approx(factor * REFERENCE.hull.volume_m3, rel=1e-12)
    for link, own in zip(copy.arm.links, REFERENCE.arm.links, strict=True):
        assert link.mass_kg == pytest.approx(factor * own.mass_kg, rel=1e-12)
        assert link.volume_m3 == pytest.approx(factor * own.volume_m3, rel=1e-12)
    assert copy.environment == REFERENCE.environment
    for thruster, own in zip(copy.thrusters, REFERENCE.thrusters, strict=True):
        assert thruster.time_constant_s == own.time_constant_s
        assert np.allclose(thruster.position_m, np.cbrt(factor) * np.array(own.position_m))


@pytest.mark.parametrize("name", MASSES)
def test_the_copy_floats_alike(name):
    """Weight and buoyancy go with L^3, their moments with L^4, in every posture and attitude."""
    length = np.cbrt(MASSES[name])
    one, other = build_model(REFERENCE), build_model(load_vehicle(name))
    rng = np.random.default_rng(3)
    for _ in range(5):
        quaternion, q = rng.normal(size=4), rng.uniform(-1.0, 1.0, REFERENCE.n_joints)
        quaternion /= np.linalg.norm(quaternion)
        own = restoring_wrench(one, quaternion, q)
        found = restoring_wrench(other, quaternion, q)
        assert np.allclose(found, wrench_scale(length, 3) * own, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", MASSES)
def test_at_the_same_speeds_the_water_resists_with_the_area(name):
    """Speeds alike, turning rates by 1/L, accelerations by 1/L: all of the hull's forces by L^2."""
    length = np.cbrt(MASSES[name])
    one, other = build_model(REFERENCE), build_model(load_vehicle(name))
    rng = np.random.default_rng(4)
    for _ in range(5):
        nu, nu_dot = rng.normal(size=6), rng.normal(size=6)
        slow = nu / np.repeat([1.0, length], 3)
        gentle = nu_dot / np.repeat([length, length**2], 3)
        own = hull_hydrodynamic_wrench(one, nu, nu_dot)
        found = hull_hydrodynamic_wrench(other, slow, gentle)
        assert np.allclose(found, wrench_scale(length, 2) * own, rtol=1e-9)


def test_every_quantity_of_a_hull_is_scaled_by_its_dimension():
    hull = {
        "linear_damping": np.ones((6, 6)).tolist(),
        "quadratic_damping": [1.0] * 6,
        "added_mass": np.ones((6, 6)).tolist(),
        "cross_terms": {"Y_uv": 1.0, "Y_ur": 1.0, "N_uv": 1.0, "N_ur": 1.0, "K_up": None},
        "fins": [{"area_m2": 1.0, "position_m": [1.0, 0.0, 2.0], "stall_deg": 20.0}],
    }
    data = {"hull": hull, "thrusters": [], "arm": {"links": []}, "sensors": {}}
    copy = scaled_data(data, 2.0)["hull"]
    assert copy["linear_damping"][0] == [4.0] * 3 + [8.0] * 3
    assert copy["linear_damping"][5] == [8.0] * 3 + [16.0] * 3
    assert copy["quadratic_damping"] == [4.0] * 3 + [32.0] * 3
    assert copy["added_mass"][0] == [8.0] * 3 + [16.0] * 3
    assert copy["added_mass"][5] == [16.0] * 3 + [32.0] * 3
    assert copy["cross_terms"] == {"Y_uv": 4, "Y_ur": 8, "N_uv": 8, "N_ur": 16, "K_up": None}
    assert copy["fins"] == [{"area_m2": 4.0, "position_m": [2.0, 0.0, 4.0], "stall_deg": 20.0}]


def test_there_and_back_is_the_same_vehicle():
    back = by_mass(by_mass(REFERENCE, 10.0), 0.1)
    own, other = yaml.safe_load(dump_vehicle(REFERENCE)), yaml.safe_load(dump_vehicle(back))
    assert flat(other) == pytest.approx(flat(own), rel=1e-12)


def flat(node):
    if isinstance(node, dict | list):
        items = node.values() if isinstance(node, dict) else node
        return [number for item in items for number in flat(item)]
    return [node] if isinstance(node, float) else []


def test_sensors_keep_their_errors_and_stand_where_they_stood():
    copy = load_vehicle("reference_auv_heavy").sensors
    assert copy.dvl.noise_m_s == REFERENCE.sensors.dvl.noise_m_s
    assert copy.gps.horizontal_noise_m == REFERENCE.sensors.gps.horizontal_noise_m
    assert np.allclose(
        copy.imu.position_m, np.cbrt(10) * np.array(REFERENCE.sensors.imu.position_m)
    )


def test_three_thrusters_on_the_reference_hull():
    vehicle = load_vehicle("reference_auv_three_thrusters")
    assert vehicle.thruster_names == ("surge_port", "surge_starboard", "heave")
    assert vehicle.hull == REFERENCE.hull
    assert vehicle.thrusters[2].position_m[0] == 0.067


def test_keywords_of_an_unscaled_copy_follow_its_own_values():
    data = {"name": "mine", "copy": {"of": "reference_auv"}}
    heavier = vehicle_from_data(data, overrides={"arm.links.3.mass_kg": 2.0})
    assert heavier.hull.mass_kg == pytest.approx(REFERENCE.hull.mass_kg - (2.0 - 1.51))


def test_a_copy_of_a_file_is_found_beside_its_own(tmp_path, monkeypatch):
    (tmp_path / "own.yaml").write_text(dump_vehicle(REFERENCE), encoding="utf-8")
    copy = tmp_path / "copy.yaml"
    copy.write_text("name: half\ncopy: {of: own.yaml, mass: 0.5}\n", encoding="utf-8")
    monkeypatch.chdir("/")
    vehicle = load_vehicle(copy, {"hull.cb_m": [0.0, 0.0, -0.001]})
    assert vehicle.hull.mass_kg == pytest.approx(REFERENCE.hull.mass_kg / 2)
    assert vehicle.hull.cb_m == (0.0, 0.0, -0.001)
    assert vehicle_from_yaml(dump_vehicle(vehicle)) == vehicle


@pytest.mark.parametrize(
    ("data", "text"),
    [
        ({"of": "nobody"}, "copy.of: unknown vehicle 'nobody'; choose one of bluerov2_alpha5"),
        ({"of": "reference_auv_heavy"}, "copy.of: reference_auv_heavy is a copy itself, of"),
        ({"of": "reference_auv", "mass": 0.0}, "mine: copy: mass: Input should be greater than 0"),
        ({"of": "reference_auv", "length": 2.0}, "known names here: mass, of"),
        ({}, "mine: copy: of: Field required"),
        ("reference_auv", "mine: copy"),
        ({"of": "nowhere.yaml"}, "nowhere.yaml: cannot be read"),
    ],
)
def test_what_cannot_be_copied_is_refused(data, text):
    with pytest.raises(VehicleFileError, match=re.escape(text)):
        vehicle_from_data({"name": "mine", "copy": data}, "mine")


@pytest.mark.parametrize("name", known_vehicles())
def test_every_vehicle_is_named_as_its_file(name):
    assert load_vehicle(name).name == name
