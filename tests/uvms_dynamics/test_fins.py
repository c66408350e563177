"""Fins against closed forms: lift at small angles, stall, induced drag, power, and the kernel."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_vehicles import REFERENCE, random_vehicle

from uvms_core.errors import VehicleFileError
from uvms_core.vehicle import load_vehicle
from uvms_core.vehicle.fins import Fin, fin_wrench, hoerner_slope
from uvms_dynamics import build_model
from uvms_dynamics.kernels.hull import hull_hydrodynamic_wrench

DENSITY = 1025.0
RUDDER = Fin(
    name="rudder", position_m=(-1.0, 0.0, 0.2), normal=(0.0, 1.0, 0.0), area_m2=0.04,
    aspect_ratio=2.0, stall_deg=20.0,
)  # fmt: skip
quick = settings(max_examples=100, deadline=None, derandomize=True)
numbers = st.lists(st.floats(-3.0, 3.0), min_size=6, max_size=6).map(np.array)


def coefficients(fin, degrees):
    """Lift, across the flow against the normal, and drag at an angle of attack, no rotation."""
    angle = np.radians(degrees)
    flow = np.array([np.cos(angle), np.sin(angle), 0.0])
    force = fin_wrench(fin, np.concatenate([flow, np.zeros(3)]), DENSITY)[:3]
    force = force / (0.5 * DENSITY * fin.area_m2)
    across = np.array([flow[1], -flow[0], 0.0])
    return force @ across, -force @ flow


def test_slope_is_the_one_printed_for_the_remus():
    """Prestero 2001, table 2.2: 3.12 at an effective aspect ratio of 2.21."""
    assert hoerner_slope(2.21) == pytest.approx(3.12, abs=0.005)
    assert hoerner_slope(1e9) == pytest.approx(0.9 * 2.0 * np.pi)
    assert hoerner_slope(1e-6) == pytest.approx(np.pi * 1e-6)


@pytest.mark.parametrize("degrees", [-2.0, 0.5, 3.0])
def test_small_angles_give_lift_by_the_slope_and_induced_drag(degrees):
    lift, drag = coefficients(RUDDER, degrees)
    assert lift == pytest.approx(RUDDER.slope * np.radians(degrees), rel=3e-3)
    induced = lift**2 / (np.pi * 0.9 * 2.0)
    assert drag == pytest.approx(0.0065 + induced, rel=1e-2)


def test_a_given_slope_replaces_the_formula():
    fin = RUDDER.model_copy(update={"lift_slope": 4.0})
    assert coefficients(fin, 1.0)[0] == pytest.approx(4.0 * np.radians(1.0), rel=1e-3)


def test_half_of_the_lift_is_lost_at_the_stall_angle_and_nothing_jumps():
    angle = np.radians(20.0)
    attached = RUDDER.slope * np.sin(angle) * np.cos(angle)
    plate = 1.17 * np.sin(angle)
    assert coefficients(RUDDER, 20.0)[0] == pytest.approx(
        0.5 * attached + 0.5 * plate * np.cos(angle), rel=1e-9
    )
    degrees = np.arange(-180.0, 180.0, 0.05)
    curve = np.array([coefficients(RUDDER, each) for each in degrees])
    assert np.abs(np.diff(curve, axis=0)).max() < 0.005
    best = degrees[np.argmax(curve[:, 0] * (np.abs(degrees) < 90.0))]
    assert 13.0 < best < 20.0


def test_across_the_flow_a_fin_is_a_plate():
    lift, drag = coefficients(RUDDER, 90.0)
    assert lift == pytest.approx(0.0, abs=1e-9)
    assert drag == pytest.approx(1.17 + 0.0065, rel=1e-3)  # all but 2e-4 has separated


def test_astern_it_pushes_against_the_flow_as_well():
    ahead, astern = coefficients(RUDDER, 3.0), coefficients(RUDDER, 177.0)
    assert astern == pytest.approx((-ahead[0], ahead[1]), rel=1e-9)
    force = fin_wrench(RUDDER, np.array([-1.0, 0.05, 0.0, 0.0, 0.0, 0.0]), DENSITY)
    assert force[1] < 0.0  # against the sway


def test_it_acts_at_its_place_with_the_local_velocity():
    """A yaw rate r is a sway x r at the fin: Y_r = -1/2 rho S C_La u x, N_r = x Y_r, K = -z Y."""
    u, r = 2.0, 1e-4
    wrench = fin_wrench(RUDDER, np.array([u, 0.0, 0.0, 0.0, 0.0, r]), DENSITY)
    side = -0.5 * DENSITY * 0.04 * (RUDDER.slope + 0.0065) * u * (-1.0 * r)
    assert wrench[1] == pytest.approx(side, rel=1e-3)
    assert wrench[5] == pytest.approx(-1.0 * wrench[1], rel=1e-6)
    assert wrench[3] == pytest.approx(-0.2 * wrench[1], rel=1e-6)


def test_incidence_adds_to_the_angle_of_attack():
    straight = np.array([1.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    force = fin_wrench(RUDDER.model_copy(update={"incidence_deg": 2.0}), straight, DENSITY)
    expected = -0.5 * DENSITY * 0.04 * 1.5**2 * RUDDER.slope * np.radians(2.0)
    assert force[1] == pytest.approx(expected, rel=1e-2)


@quick
@given(numbers, st.floats(-30.0, 30.0))
def test_a_fin_takes_power_from_every_motion(nu, incidence):
    fin = RUDDER.model_copy(update={"incidence_deg": incidence})
    wrench = fin_wrench(fin, nu, DENSITY)
    assert nu @ wrench <= 1e-12 * np.abs(nu) @ np.abs(wrench)


@quick
@given(numbers, st.integers(0, 10))
def test_the_kernel_is_the_twin(nu, seed):
    """Fins alone, by the difference of two hulls that are alike but for them."""
    vehicle = random_vehicle(2 * seed + 1, 1)
    bare = vehicle.model_copy(update={"hull": vehicle.hull.model_copy(update={"fins": ()})})
    found = hull_hydrodynamic_wrench(build_model(vehicle), nu, np.zeros(6))
    found -= hull_hydrodynamic_wrench(build_model(bare), nu, np.zeros(6))
    density = vehicle.environment.water_density_kg_m3
    expected = np.sum([fin_wrench(fin, nu, density) for fin in vehicle.hull.fins], axis=0)
    scale = 1e3 * np.abs(nu).max() * (1.0 + np.abs(nu).max())  # of all the rest, which cancels
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12 * scale)


def test_at_rest_there_is_no_force():
    still = hull_hydrodynamic_wrench(build_model(REFERENCE), np.zeros(6), np.zeros(6))
    np.testing.assert_array_equal(still, np.zeros(6))


def test_a_fin_that_cannot_be_is_named():
    fin = RUDDER.model_dump() | {"chord": [0.0, 1.0, 0.0]}
    with pytest.raises(VehicleFileError, match=r"hull\.fins\.0: chord must be perpendicular"):
        load_vehicle(overrides={"hull.fins": [fin]})
    twice = [RUDDER.model_dump(), RUDDER.model_dump()]
    with pytest.raises(VehicleFileError, match="fin names must differ"):
        load_vehicle(overrides={"hull.fins": twice})
