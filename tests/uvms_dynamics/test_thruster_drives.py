"""The plant's thrusters: limits by direction, dead zone, curve, lag and slew."""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_control.allocation import ThrustAllocator
from uvms_control.config import AllocatorConfig
from uvms_core.signals import ThrusterCommand, Wrench
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import thruster_matrix
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.drives import ThrusterDrives

BLUEROV = load_vehicle("bluerov2_alpha5")
M = BLUEROV.n_thrusters
TAU, SLEW = 0.1, 400.0


def run(plant, ticks, thrust):
    for _ in range(ticks):
        plant.step(ThrusterCommand(plant.stamp, np.array(thrust, dtype=float)), None)
    return plant.truth().thrust


def bluerov_plant():
    return Plant(BLUEROV, PlantConfig(), 1)


@pytest.mark.parametrize(("wanted", "expected"), [(1e3, 51.5), (-1e3, -39.9), (50.0, 50.0)])
def test_each_direction_has_its_own_limit(wanted, expected):
    thrust = run(bluerov_plant(), 60, [wanted] * M)
    np.testing.assert_allclose(thrust, expected, rtol=1e-9)


@pytest.mark.parametrize(
    ("wanted", "expected"), [(0.19, 0.0), (0.21, 0.4), (-0.14, 0.0), (-0.2, -0.3)]
)
def test_in_its_dead_zone_a_thruster_rests_or_gives_its_least(wanted, expected):
    thrust = run(bluerov_plant(), 60, [wanted] * M)
    np.testing.assert_allclose(thrust, expected, atol=1e-9)


def test_from_rest_it_slews_and_then_lags():
    """T' = min(s, (u - T) / tau): a straight line until u - T = s tau, then an exponential."""
    plant, u = bluerov_plant(), 50.0
    begins = (u - SLEW * TAU) / SLEW  # 0.025 s
    for tick in range(1, 9):
        t = 0.05 * tick
        thrust = run(plant, 1, [u] * M)
        np.testing.assert_allclose(thrust, u - SLEW * TAU * np.exp(-(t - begins) / TAU), rtol=1e-5)


def test_it_slews_as_fast_astern():
    first = run(bluerov_plant(), 1, [-1e3] * M)
    t, u = 0.05, -39.9
    np.testing.assert_allclose(first, u * (1.0 - np.exp(-t / TAU)), rtol=1e-6)  # 399 N/s: no slew


def test_what_is_allocated_is_what_the_thrusters_give_in_the_end():
    allocator, matrix = ThrustAllocator(BLUEROV, AllocatorConfig()), thruster_matrix(BLUEROV)
    rng = np.random.default_rng(3)
    for scale in (0.02, 0.2, 2.0):
        tau = scale * rng.normal(size=6) * [50.0, 50.0, 50.0, 4.0, 0.0, 10.0]
        command, allocation = allocator.step(Wrench(0, tau))
        achieved = matrix @ run(bluerov_plant(), 80, command.thrust)
        np.testing.assert_allclose(achieved, allocation.achieved, atol=1e-6)


def test_another_curve_in_the_plant_gives_another_thrust():
    """Half the thrust at every command: what is commanded as 20 N comes out as 10 N."""
    curve = BLUEROV.thrusters[0].curve
    weak = {
        "ahead_n": [0.5 * c for c in curve.ahead_n],
        "astern_n": [0.5 * c for c in curve.astern_n],
    }
    real = load_vehicle(
        "bluerov2_alpha5", {"thrusters.fore_port.curve": weak, "thrusters.aft_port.dead_zone": 0.2}
    )
    drives = ThrusterDrives(BLUEROV, real)
    thrust = drives.realised(np.array([20.0, 20.0, 20.0, 20.0, -20.0, 0.1]))
    others = [0, 2, 4, 5]
    np.testing.assert_allclose(thrust[others], [20.0, 20.0, -20.0, 0.0], rtol=1e-12)
    assert thrust[1] == pytest.approx(10.0)
    command = float(BLUEROV.thrusters[3].command(20.0))
    assert thrust[3] == pytest.approx(float(real.thrusters[3].thrust(command)))
    assert thrust[3] < 18.0


def test_ideal_drives_pass_on_what_they_are_given():
    thrust = np.array([1.0, -2.0, 3.0, 1e6, 0.0, 1e-9, 5.0])
    assert ThrusterDrives(REFERENCE, REFERENCE).realised(thrust) is thrust


def test_half_astern_of_the_reference_vehicle_is_kept_by_its_own_limits():
    vehicle = load_vehicle(
        overrides={"thrusters.main.limit_n": None, "thrusters.main.limits_n": [-20.0, 98.0]}
    )
    for wanted, expected in ((-1e3, -20.0), (1e3, 98.0)):
        thrust = run(Plant(vehicle, PlantConfig(), 1), 100, [wanted] + [0.0] * 6)
        assert thrust[0] == pytest.approx(expected, rel=1e-9)
