"""Vehicle files that make no sense are refused or warned of, each for the right reason."""

import math
import re
from typing import Any

import numpy as np
import pytest
import yaml
from arms import MADE
from random_vehicles import REFERENCE, random_vehicle
from scaled_vehicles import by_mass

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data, vehicle_warnings
from uvms_core.vehicle.locate import reference_file

IMPOSSIBLE = {
    "centre of buoyancy 50 m off": (
        {"hull.cb_m": [50.0, 0.0, 0.0]},
        "hull.cb_m: 50 m along x is more than 1.5 times the hull's half length of 1.2 m",
    ),
    "centre of gravity 2 m below a hull of 0.38 m": (
        {"hull.cg_m": ["trim", "trim", 2.0]},
        "hull.cg_m: 2 m along z is more than 1.5 times the hull's half length of 0.19 m",
    ),
    "mass 1e9 kg": (
        {"hull.mass_kg": 1e9},
        r"hull.mass_kg: 1e\+09 kg in 0.1815 m\^3 are 5.511e\+09 kg/m\^3, more than 22600",
    ),
    "volume in litres": (
        {"hull.volume_m3": 181.46},
        r"hull.volume_m3: 181.5 m\^3 are 1e\+03 times those of hull.spheroid .* in litres",
    ),
    "volume in litres, mass given": (
        {"hull.volume_m3": 181.46, "hull.mass_kg": 184.5},
        r"hull.volume_m3: 184.5 kg in 181.5 m\^3 are 1.017 kg/m\^3, less than 5: no body .* litres",
    ),
    "gravity 981": (
        {"environment.gravity_m_s2": 981.0},
        r"environment.gravity_m_s2: 981 m/s\^2 is above 25; no planet",
    ),
    "water density in g/cm^3": (
        {"environment.water_density_kg_m3": 1.025},
        r"environment.water_density_kg_m3: 1.025 kg/m\^3 is outside 400 to 2000; no vehicle floats",
    ),
    "a link's radius in millimetres": (
        {"arm.links.1.cylinder.radius_m": 45.0},
        r"arm.links.1.volume_m3: 3.3 kg in 2926 m\^3 are 0.001128 kg/m\^3, less than 5",
    ),
    "inertia in g m^2": (
        {"hull.inertia_kg_m2": [2660.0, 54500.0, 54500.0]},
        r"hull.inertia_kg_m2: 5.45e\+04 kg m\^2 put 184.5 kg 16.98 m from their centre, more",
    ),
    "inertia in t m^2": (
        {"hull.inertia_kg_m2": [2.66e-3, 5.45e-2, 5.45e-2]},
        r"hull.inertia_kg_m2: its greatest moment is 0.0545 kg m\^2, below 1.15, that of as much",
    ),
    "a link's centre half a metre beside it": (
        {"arm.links.2.cg_m": [0.5, 0.0, 0.19]},
        "arm.links.2.cg_m: 0.5 m from the link's axis are more than 6 times its 0.04 m",
    ),
    "a mounting angle of 14 turns": (
        {"arm.base.rpy_deg": [0.0, 5156.0, 0.0]},
        "arm.base.rpy_deg.1: 5156 degrees are more than two turns, 720",
    ),
    "a sensor's place in centimetres": (
        {"sensors.dvl.position_m": [-30.0, 0.0, 17.0]},
        "sensors.dvl.position_m: 34.48 m from the body origin, more than 20 times",
    ),
    "a thruster's place in millimetres": (
        {"thrusters.main.position_m": [-1200.0, 0.0, 0.0]},
        "thrusters.0.position_m: main is 1200 m from the body origin, more than 50 times",
    ),
}

ODD = {
    "370 kg in a hull that displaces 186": (
        {"hull.mass_kg": 370.0},
        "hull.mass_kg: vehicle and arm have 378.82 kg and displace 193.29 kg: it sinks with 1820 N,"
        " more than the 196 N that the thrusters can push up or down; it cannot hold its depth",
    ),
    "gravity 0.98": (
        {"environment.gravity_m_s2": 0.98},
        "environment.gravity_m_s2: 0.98 m/s^2 is outside 9.76 to 9.84",
    ),
    "all thrusters along x": (
        {f"thrusters.{k}.direction": [1.0, 0.0, 0.0] for k in range(7)},
        "thrusters: the 7 of them, all along one line, cannot push along sway, heave, roll, pitch"
        " alone: the layout has rank 2, below 6",
    ),
    "three thrusters": (
        {"thrusters": [each.model_dump() for each in REFERENCE.thrusters[:3]]},
        "thrusters: the 3 of them cannot push along heave, roll, pitch alone: the layout has rank",
    ),
    "weight above buoyancy": (
        {"hull.cg_m": ["trim", "trim", -0.03]},
        "hull.cg_m: with the arm in posture stowed the vehicle turns over: its metacentric height",
    ),
    "10 kg of ballast aft": (
        {
            "hull.attachments": [
                {"name": "a", "position_m": [-0.9, 0, 0], "wet_weight_n": 98, "mass_kg": 11}
            ],
            "hull.cg_m": [-0.0097, 0.0, 0.012],
        },
        "the vehicle floats at",
    ),
    "a drive too weak for its arm": (
        {"arm.joints.shoulder.effort_limit_nm": 1.0},
        "arm.joints.1.effort_limit_nm: 1 N m are below the 2.9 N m of weight and buoyancy",
    ),
    "a brake too weak for its arm": (
        {"arm.joints.elbow.brake_nm": 2.0},
        "arm.joints.2.brake_nm: 2 N m are below the 3.11 N m of weight and buoyancy",
    ),
    "no damping in heave": (
        {"hull.fins": [], "hull.linear_damping.2": 0.0, "hull.quadratic_damping.2": 0.0},
        "hull.quadratic_damping: neither linear nor quadratic damping in heave",
    ),
    "a joint limit of ten turns": (
        {"arm.joints.wrist.upper_deg": 3600.0},
        "arm.joints.3.upper_deg: 3600 degrees are more than two turns",
    ),
}


@pytest.mark.parametrize("case", IMPOSSIBLE)
def test_what_no_vehicle_can_be_is_refused(case, saw):
    overrides, reason = IMPOSSIBLE[case]
    with pytest.raises(VehicleFileError, match=reason):
        load_vehicle(overrides=overrides)
    saw(case, "the file is refused; field, value, bound and reason are named")


@pytest.mark.parametrize("case", ODD)
def test_what_is_odd_is_warned_of(case, saw):
    overrides, text = ODD[case]
    warnings = vehicle_warnings(load_vehicle(overrides=overrides))
    assert any(text in line for line in warnings), warnings
    saw(case, "warned of, with field, value, bound and reason")


def in_radians(node: Any) -> Any:
    """All angles of an arm's section as a careless author would give them."""
    if isinstance(node, list):
        return [in_radians(each) for each in node]
    if not isinstance(node, dict):
        return node
    return {
        name: converted(value) if str(name).endswith("_deg") else in_radians(value)
        for name, value in node.items()
    }


def converted(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: converted(each) for name, each in value.items()}
    return [math.radians(x) for x in value] if isinstance(value, list) else math.radians(value)


def test_an_arm_in_radians_is_warned_of(saw):
    data = yaml.safe_load(reference_file().read_text(encoding="utf-8"))
    data["arm"] = in_radians(data["arm"])
    warnings = vehicle_warnings(vehicle_from_data(data))
    for joint in REFERENCE.arm.joints:
        assert any(f"joint {joint.name} can turn" in line for line in warnings)
    assert any("alpha_deg: 1.5708 degrees is the number pi/2" in line for line in warnings)
    saw("angles in radians", "warned of: joints that can turn by two degrees, pi/2 as degrees")


def test_all_that_is_impossible_is_said_at_once():
    with pytest.raises(VehicleFileError) as fault:
        load_vehicle(
            overrides={
                "hull.cb_m": [0.0, 9.0, 0.0],
                "hull.mass_kg": 184.5,
                "hull.volume_m3": 181.5,
                "arm.base.rpy_deg": [0.0, 0.0, 1000.0],
            }
        )
    fields = [re.search(r": ((hull|arm)\.\w+)", line)[1] for line in str(fault.value).splitlines()]
    assert {"hull.cb_m", "hull.volume_m3", "arm.base"} <= set(fields)


def assert_accepted(vehicle: Vehicle) -> None:
    """It loads again from what is written; warnings are allowed."""
    assert vehicle_from_data(vehicle.model_dump(mode="json")) == vehicle
    assert all(": " in line for line in vehicle_warnings(vehicle))


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5", *MADE])
def test_vehicles_of_the_project_are_accepted_without_any_oddity(name):
    vehicle = vehicle_from_data(MADE[name]()) if name in MADE else load_vehicle(name)
    warnings = vehicle_warnings(vehicle)
    if name == "bluerov2_alpha5":  # it has no pitch thruster, as the real one
        assert len(warnings) == 1
        assert warnings[0].startswith("thrusters: the 6 of them cannot push along pitch alone")
    else:
        assert warnings == ()


@pytest.mark.parametrize("factor", [1e-3, 0.1, 10.0, 40.0])
@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_copies_of_200_g_to_7_t_are_accepted_like_the_original(name, factor):
    """Bounds are ratios: what is said does not depend on the size."""
    original = load_vehicle(name)
    copy = by_mass(original, factor)
    assert copy.hull.mass_kg == pytest.approx(factor * original.hull.mass_kg)
    assert vehicle_warnings(copy) == vehicle_warnings(original)
    assert_accepted(copy)


@pytest.mark.parametrize("n", [1, 4, 8])
def test_random_vehicles_are_accepted(n):
    """Random arms, bodies of half to twice the density of water, centres anywhere inside."""
    for seed in range(12):
        assert_accepted(random_vehicle(seed, n))


def test_a_crawler_is_accepted():
    """A hull of twice the density of water with two thrusters to drive and turn."""
    data = REFERENCE.model_dump(mode="json")
    data["hull"]["mass_kg"] *= 2.0
    data["hull"]["inertia_kg_m2"] = (2.0 * np.array(data["hull"]["inertia_kg_m2"])).tolist()
    data["thrusters"] = data["thrusters"][:2]
    crawler = vehicle_from_data(data)
    assert any("sinks with" in line for line in vehicle_warnings(crawler))
    assert_accepted(crawler)


@pytest.mark.parametrize("field", ["gravity_m_s2", "water_density_kg_m3"])
def test_a_study_without_weight_or_water_is_accepted(field):
    data = REFERENCE.model_dump(mode="json")
    data["environment"][field] = 1e-30
    assert_accepted(vehicle_from_data(data))
