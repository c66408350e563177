"""The model with a payload against the plant's loaded vehicle, and the payload's forces."""

import numpy as np
import pytest

from uvms_core.signals import Payload
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, forward_dynamics, inverse_dynamics, mass_matrix
from uvms_dynamics.payload import LoadedModel, payload_forces, with_payload
from uvms_dynamics.simulation.events.load import Load, loaded

VEHICLES = {name: load_vehicle(name) for name in ("reference_auv", "bluerov2_alpha5")}
PLACE = np.array([0.04, -0.03, 0.1])
RNG = np.random.default_rng(3)


def motion(n, rng):
    quaternion = rng.standard_normal(4)
    return (
        quaternion / np.linalg.norm(quaternion),
        0.3 * rng.standard_normal(6),
        rng.standard_normal(6),
        *rng.standard_normal((3, n)),
    )


@pytest.mark.parametrize("name", VEHICLES)
def test_it_is_the_plants_loaded_vehicle(name):
    vehicle, rng = VEHICLES[name], np.random.default_rng(1)
    volume, mass = 5e-4, 1.02
    point = Load(mass_kg=mass, volume_m3=volume, at_m=tuple(PLACE), inertia_kg_m2=(1e-9,) * 3)
    water = vehicle.environment.water_density_kg_m3 * volume
    weight = (mass - water) * vehicle.environment.gravity_m_s2
    model = with_payload(build_model(vehicle), mass + 0.5 * water, weight, PLACE)
    plants = build_model(loaded(vehicle, point))
    for _ in range(5):
        state = motion(vehicle.n_joints, rng)
        np.testing.assert_allclose(
            inverse_dynamics(model, *state), inverse_dynamics(plants, *state), rtol=1e-9, atol=1e-7
        )
        np.testing.assert_allclose(
            mass_matrix(model, state[3]), mass_matrix(plants, state[3]), atol=1e-8
        )


@pytest.mark.parametrize("name", VEHICLES)
def test_its_forces_are_the_difference_that_it_makes(name):
    """At p = 0, and what is odd in p: the moments of inertia m p p^T are even."""
    vehicle, rng = VEHICLES[name], np.random.default_rng(2)
    model, mass, weight = build_model(vehicle), 1.3, 4.2
    for _ in range(5):
        state = motion(vehicle.n_joints, rng)

        def forces(place, state=state):
            loaded = with_payload(model, mass, weight, place)
            return inverse_dynamics(model, *state) - inverse_dynamics(loaded, *state)

        columns = payload_forces(model, *state)
        at_tool = columns[:, [0, 4]] @ np.array([weight, mass])
        odd = columns[:, [1, 2, 3, 5, 6, 7]] @ np.r_[weight * PLACE, mass * PLACE]
        np.testing.assert_allclose(at_tool, forces(np.zeros(3)), rtol=1e-9, atol=1e-8)
        np.testing.assert_allclose(odd, 0.5 * (forces(PLACE) - forces(-PLACE)), atol=1e-8)


def test_nothing_is_the_model_itself():
    model = build_model(VEHICLES["reference_auv"])
    np.testing.assert_array_equal(with_payload(model, 0.0, 0.0, PLACE), model)
    state = motion(4, RNG)
    heavy = with_payload(model, 2.0, 8.0, PLACE)
    tau = inverse_dynamics(heavy, *state)
    quaternion, nu, nu_dot, q, q_dot, q_ddot = state
    found = forward_dynamics(heavy, quaternion, nu, q, q_dot, tau)
    np.testing.assert_allclose(found, np.r_[nu_dot, q_ddot], atol=1e-8)


def test_a_loaded_model_follows_what_is_held_and_is_not_made_anew_for_nothing():
    def payload(held, weight):
        return Payload(held, 1.3, 0.1, weight, 0.1, PLACE, np.full(3, 0.01))

    bare = build_model(VEHICLES["reference_auv"])
    loaded = LoadedModel(bare)
    assert not loaded.take(None)
    assert not loaded.take(payload(False, 5.0))
    assert loaded.take(payload(True, 5.0))
    np.testing.assert_array_equal(loaded.model, with_payload(bare, 1.3, 5.0, PLACE))
    assert not loaded.take(payload(True, 5.01))
    assert loaded.take(payload(True, 6.0))
    np.testing.assert_array_equal(loaded.model, with_payload(bare, 1.3, 6.0, PLACE))
    assert loaded.take(payload(False, 0.0))
    assert loaded.model is bare
