"""Mismatch of hulls with cross terms: lift is no part of the added mass, and damping dissipates."""

import numpy as np
import pytest
from published_hulls import REMUS_100, hull_vehicle
from random_vehicles import REFERENCE

from uvms_core.vehicle.damping import lift_matrix, linear_matrix, quadratic_matrix
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.plant.as_built import as_built
from uvms_dynamics.simulation.plant.mismatch import Mismatch

REMUS = hull_vehicle(REMUS_100)
SHARES = (
    "mass",
    "added_mass",
    "damping",
    "link_mass",
    "link_added_mass",
    "link_drag",
    "thrust",
)
SHIFTS = {"buoyancy_centre_m": 0.0024, "gravity_centre_m": 0.001, "weight_n": 5.0}


def built(vehicle, seed, **mismatch):
    return as_built(vehicle, PlantConfig(mismatch=Mismatch(**mismatch)), seed)


@pytest.mark.parametrize("seed", range(6))
def test_the_lift_stays_when_added_mass_is_drawn(seed):
    """N_uv = -24.0 of REMUS is -13.43 of Munk's moment and -10.57 of lift: that is the fins'."""
    drawn = built(REMUS, seed, added_mass=0.2).vehicle.hull
    assert abs(drawn.added_mass[1][1] / 35.5 - 1.0) > 1e-4
    np.testing.assert_allclose(lift_matrix(drawn), lift_matrix(REMUS.hull), rtol=1e-12)


@pytest.mark.parametrize("added_mass", [0.0, 0.2])
def test_coupled_damping_is_scaled_as_a_whole_with_its_cross_terms(added_mass):
    plant = built(REMUS, 3, damping=0.2, added_mass=added_mass)
    factor = 1.0 + plant.mismatch["damping"]
    assert abs(factor - 1.0) > 0.01
    for matrix in (linear_matrix, quadratic_matrix, lift_matrix):
        np.testing.assert_allclose(
            matrix(plant.vehicle.hull), factor * matrix(REMUS.hull), rtol=1e-12
        )


@pytest.mark.parametrize("share", [0.2, 0.5])
@pytest.mark.parametrize("vehicle", [REMUS, REFERENCE], ids=["REMUS", "reference"])
def test_no_seed_of_a_valid_vehicle_is_refused(vehicle, share):
    """`as_built` raises where damping would feed energy or a body could not be."""
    mismatch = dict.fromkeys(SHARES, share) | SHIFTS
    drawn = [built(vehicle, seed, **mismatch).mismatch["mass"] for seed in range(60)]
    assert len(set(drawn)) == 60


def test_an_override_of_added_mass_leaves_the_lift():
    config = PlantConfig(vehicle_overrides={"hull.added_mass.1.1": 40.0})
    hull = as_built(REMUS, config, 1).vehicle.hull
    assert hull.added_mass[1][1] == 40.0
    np.testing.assert_allclose(lift_matrix(hull), lift_matrix(REMUS.hull), rtol=1e-12)
