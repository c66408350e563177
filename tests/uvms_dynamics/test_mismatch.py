"""The plant's own vehicle: overrides that nothing trims away, and draws by the seed."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.errors import ConfigError
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.statics import buoyancy, equilibrium, first_moment
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.plant.as_built import as_built
from uvms_dynamics.simulation.plant.mismatch import Mismatch

STOWED = np.radians(REFERENCE.arm.stowed_deg)
SEEDS = range(1, 41)
EVERY = {
    "mass": 0.2,
    "added_mass": 0.3,
    "damping": 0.2,
    "link_mass": 0.2,
    "link_added_mass": 0.2,
    "link_drag": 0.2,
    "thrust": 0.1,
    "buoyancy_centre_m": 0.0024,
    "gravity_centre_m": 0.001,
    "weight_n": 5.0,
}


def built(seed=1, overrides=None, **mismatch):
    config = PlantConfig(mismatch=Mismatch(**mismatch), vehicle_overrides=overrides or {})
    return as_built(REFERENCE, config, seed)


def test_without_mismatch_the_plant_has_the_nominal_vehicle():
    assert built().vehicle is REFERENCE
    assert not built().differs


def test_a_shifted_centre_of_buoyancy_is_not_trimmed_away():
    """tan(roll) = -y B / (P_z): the vehicle floats heeled by what the shift gives."""
    shifted = built(overrides={"hull.cb_m": [0.0, 0.0024, 0.0]}).vehicle
    force = 1025.0 * 9.81 * REFERENCE.hull.volume_m3
    hanging = first_moment(REFERENCE, STOWED)[2]
    expected = -np.degrees(np.arctan2(0.0024 * force, hanging))
    assert abs(equilibrium(REFERENCE, STOWED).roll_deg) < 1e-6
    assert equilibrium(shifted, STOWED).roll_deg == pytest.approx(expected, rel=1e-9)
    trimmed = load_vehicle(None, {"hull.cb_m": [0.0, 0.0024, 0.0]})
    assert abs(equilibrium(trimmed, STOWED).roll_deg) < 1e-6


def test_draws_are_within_their_half_widths_and_fill_them():
    draws = {name: [] for name in EVERY}
    for seed in SEEDS:
        for name, values in built(seed, **EVERY).mismatch.items():
            draws[name] += np.atleast_1d(values).tolist()
    for name, values in draws.items():
        spread = np.array(values) / EVERY[name]
        assert np.abs(spread).max() <= 1.0, name
        assert spread.min() < -0.8, name
        assert spread.max() > 0.8, name


def test_a_draw_depends_on_the_seed_and_on_its_own_name_alone():
    alone, all_together = built(3, mass=0.2), built(3, **EVERY)
    assert alone.mismatch["mass"] == all_together.mismatch["mass"]
    assert built(3, **EVERY).mismatch == all_together.mismatch
    assert built(4, **EVERY).mismatch != all_together.mismatch


@pytest.mark.parametrize("seed", range(1, 11))
def test_what_is_drawn_is_a_possible_vehicle(seed):
    """`as_built` checks it as a vehicle file is; here the triangle inequality by itself."""
    vehicle = built(seed, **{**EVERY, "mass": 0.5, "link_mass": 0.5, "added_mass": 0.5}).vehicle
    for body in (vehicle.hull, *vehicle.arm.links):
        moments = np.linalg.eigvalsh(np.array(body.inertia_kg_m2))
        assert moments[0] > 0.0
        assert moments[2] <= moments[:2].sum() * (1.0 + 1e-9)
        assert np.linalg.eigvalsh(np.array(body.added_mass))[0] > -1e-9


def test_mass_is_water_inside_the_hull():
    """It weighs nothing: net weight and righting moment stay, mass and inertia do not."""
    drawn = built(2, mass=0.2)
    share, hull = drawn.mismatch["mass"], drawn.vehicle.hull
    assert abs(share) > 0.01
    assert hull.mass_kg == pytest.approx((1.0 + share) * REFERENCE.hull.mass_kg)
    np.testing.assert_allclose(
        hull.inertia_kg_m2, (1.0 + share) * np.array(REFERENCE.hull.inertia_kg_m2)
    )
    assert buoyancy(drawn.vehicle).net_weight_n == pytest.approx(0.0, abs=1e-9)
    np.testing.assert_allclose(
        first_moment(drawn.vehicle, STOWED), first_moment(REFERENCE, STOWED), atol=1e-9
    )


def test_each_field_changes_what_it_says_and_nothing_else():
    link = REFERENCE.arm.links[1]
    masses = built(5, link_mass=0.2)
    factor = 1.0 + masses.mismatch["link_mass"][1]
    assert masses.vehicle.arm.links[1].mass_kg == pytest.approx(factor * link.mass_kg)
    assert masses.vehicle.arm.links[1].volume_m3 == link.volume_m3
    assert masses.vehicle.hull == REFERENCE.hull
    added = built(5, added_mass=0.2)
    np.testing.assert_allclose(
        np.diag(added.vehicle.hull.added_mass),
        np.diag(REFERENCE.hull.added_mass) * (1.0 + np.array(added.mismatch["added_mass"])),
    )
    assert added.vehicle.arm == REFERENCE.arm
    heavy = built(5, weight_n=5.0)
    assert buoyancy(heavy.vehicle).net_weight_n == pytest.approx(heavy.mismatch["weight_n"])
    drag = built(5, link_drag=0.2)
    np.testing.assert_allclose(
        drag.vehicle.arm.drag_coefficient.cd,
        np.array(REFERENCE.arm.drag_coefficient.cd) * (1.0 + drag.mismatch["link_drag"][0]),
    )


def test_a_mismatched_thruster_gives_its_share_of_the_command():
    config = PlantConfig(mismatch=Mismatch(thrust=0.2))
    plant = Plant(REFERENCE, config, 7)
    command = np.full(REFERENCE.n_thrusters, 10.0)
    for _ in range(60):
        plant.step(
            ThrusterCommand(plant.stamp, command),
            JointCommand(plant.stamp, np.zeros(REFERENCE.n_joints)),
        )
    expected = 10.0 * (1.0 + np.array(plant.built.mismatch["thrust"]))
    np.testing.assert_allclose(plant.truth().thrust, expected, rtol=1e-6)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        ({"hull.masskg": 1.0}, "hull has no 'masskg'; choose from"),
        ({"hull.mass_kg": -1.0}, "hull.mass_kg"),
        ({"sensors.dvl.rate_hz": 10.0}, "sensors and their rates"),
        ({"thrusters.main.name": "other"}, "names of the thrusters"),
        ({"hull.cb_m": [0.0, 5.0, 0.0]}, "hull.cb_m"),
    ],
)
def test_an_override_that_cannot_be_is_refused_by_name(overrides, words):
    with pytest.raises(ConfigError, match=f"(?s)vehicle_overrides: .*{words}"):
        built(overrides=overrides)


@pytest.mark.parametrize(
    ("path", "value", "instead"),
    [
        ("hull.spheroid.length_m", 3.0, "hull.volume_m3, hull.inertia_kg_m2, hull.added_mass"),
        ("hull.spheroid.diameter_m", 0.3, "hull.volume_m3, hull.inertia_kg_m2, hull.added_mass"),
        ("arm.links.0.cylinder.radius_m", 0.05, "arm.links.0.volume_m3, arm.links.0.cg_m"),
        ("arm.links.1.cylinder", None, "arm.links.1.volume_m3, arm.links.1.cg_m"),
    ],
)
def test_an_override_of_a_shape_that_is_worked_out_is_refused(path, value, instead):
    words = f"vehicle_overrides: {path} changes nothing of the plant.*{instead}"
    with pytest.raises(ConfigError, match=words):
        built(overrides={path: value})


def test_a_shape_may_be_overridden_where_something_follows_from_it_again():
    longer = {"hull.spheroid.length_m": 3.0, "hull.added_mass": "spheroid"}
    added = np.array(built(overrides=longer).vehicle.hull.added_mass)
    assert added[1, 1] > 1.1 * np.array(REFERENCE.hull.added_mass)[1, 1]
