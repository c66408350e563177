"""Equilibrium, periods and joint loads against the simulated vehicle and the kernels."""

import numpy as np
import pytest
from random_vehicles import REFERENCE, random_vehicle

from uvms_core.rotations import quat_to_rpy
from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data
from uvms_core.vehicle.plausible.stability import postures
from uvms_core.vehicle.statics import (
    buoyancy,
    equilibrium,
    first_moment,
    joint_loads,
    worst_joint_loads,
)
from uvms_dynamics import build_model, inverse_dynamics, restoring_wrench, rpy_to_quat
from uvms_dynamics.model.floating import natural_periods
from uvms_dynamics.simulation import make_state, make_system, simulate
from uvms_dynamics.simulation.integrator import QUATERNION, VELOCITY

LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
VEHICLES = [REFERENCE, load_vehicle("bluerov2_alpha5"), random_vehicle(3, 5)]
names = pytest.mark.parametrize("vehicle", VEHICLES, ids=lambda v: f"{v.name} {v.n_joints}")


def rigid(vehicle: Vehicle, damped: bool) -> Vehicle:
    """The vehicle with joints that do not move (rotors of a thousand tonnes), as it floats.

    Neutral, so that it stays where it is; with strong damping or without any.
    """
    data = vehicle.model_dump(mode="json")
    data["tether"] = None
    data["hull"]["mass_kg"] -= buoyancy(vehicle).mass_kg - buoyancy(vehicle).displaced_kg
    for joint in data["arm"]["joints"]:
        joint["rotor_inertia_kg_m2"] = 1e9
    for link in data["arm"]["links"]:
        link["drag"] = []
    factor = 1.0 if damped else 0.0
    hull = data["hull"]
    hull["linear_damping"] = (np.array([50.0] * 3 + [5.0] * 3) * factor).tolist()
    hull["quadratic_damping"] = [0.0] * 6
    return vehicle_from_data(data)


@names
def test_weight_and_moment_are_those_of_the_kernels(vehicle):
    for _, q in postures(vehicle):
        quat = rpy_to_quat(0.3, -0.5, 1.0)
        wrench = restoring_wrench(build_model(vehicle), quat, q)
        sr, cr, sp, cp = np.sin(0.3), np.cos(0.3), np.sin(-0.5), np.cos(-0.5)
        down = np.array([-sp, sr * cp, cr * cp])
        scale = np.abs(wrench).max()
        expected = np.concatenate(
            [buoyancy(vehicle).net_weight_n * down, np.cross(first_moment(vehicle, q), down)]
        )
        np.testing.assert_allclose(wrench, expected, atol=1e-9 * scale)


@names
def test_joint_loads_are_what_the_drives_must_hold(vehicle):
    model, still, n = build_model(vehicle), np.zeros(6), vehicle.n_joints
    for _, q in postures(vehicle):
        held = inverse_dynamics(model, LEVEL, still, still, q, np.zeros(n), np.zeros(n))[6:]
        np.testing.assert_allclose(joint_loads(vehicle, q), -held, atol=1e-9)
        rng = np.random.default_rng(1)
        worst = worst_joint_loads(vehicle, q)
        quats = rng.normal(size=(3000, 4))
        quats /= np.linalg.norm(quats, axis=1)[:, None]
        found = np.max(
            [
                np.abs(inverse_dynamics(model, x, still, still, q, np.zeros(n), np.zeros(n))[6:])
                for x in quats
            ],
            axis=0,
        )
        assert (found <= worst + 1e-9).all()
        np.testing.assert_allclose(found, worst, rtol=0.02, atol=1e-9)


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_the_simulated_vehicle_comes_to_rest_at_the_equilibrium(name):
    vehicle = rigid(load_vehicle(name), damped=True)
    for _, q in postures(vehicle):
        rest = equilibrium(vehicle, q)
        start = make_state(q, vehicle.n_thrusters, position=(0.0, 0.0, 50.0))
        thrust, effort = np.zeros(vehicle.n_thrusters), np.zeros(vehicle.n_joints)
        end = simulate(make_system(vehicle), start, thrust, effort, 0.02, 30_000)[-1]
        roll, pitch, _ = np.degrees(quat_to_rpy(end[QUATERNION:VELOCITY]))
        assert roll == pytest.approx(rest.roll_deg, abs=0.05)
        assert pitch == pytest.approx(rest.pitch_deg, abs=0.05)


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_the_simulated_vehicle_swings_with_the_natural_periods(name):
    """Tilted by half a degree about one mode; the spectrum of the undamped swing has its peak."""
    vehicle = rigid(load_vehicle(name), damped=False)
    q = np.radians(vehicle.arm.stowed_deg)
    rest, periods = equilibrium(vehicle, q), natural_periods(vehicle, q)
    thrust, effort = np.zeros(vehicle.n_thrusters), np.zeros(vehicle.n_joints)
    for k, period in enumerate(periods):
        tilt = np.radians([rest.roll_deg + 0.5 * (k == 0), rest.pitch_deg + 0.5 * (k == 1)])
        start = make_state(q, vehicle.n_thrusters, quat=rpy_to_quat(*tilt, 0.0))
        states = simulate(make_system(vehicle), start, thrust, effort, 0.01, 40_000)
        angle = np.unwrap(2.0 * np.arcsin(states[:, QUATERNION + k]))
        assert peak_period(angle, 0.01) == pytest.approx(period, rel=0.01)


def peak_period(signal: np.ndarray, step: float) -> float:
    """Period of the greatest line of the spectrum, interpolated."""
    window = np.hanning(len(signal))
    size = 8 * len(signal)
    power = np.abs(np.fft.rfft((signal - signal.mean()) * window, size))
    k = int(np.argmax(power[1:])) + 1
    return size * step / k


def test_a_vehicle_whose_weight_is_above_its_buoyancy_turns_over():
    above = load_vehicle(overrides={"hull.cg_m": ["trim", "trim", -0.05]})
    q = np.radians(above.arm.stowed_deg)
    rest = equilibrium(above, q)
    assert rest.metacentric_height_m < 0.0
    assert rest.tilt_deg == pytest.approx(180.0)


def test_roll_period_of_the_reference_vehicle_by_hand():
    """T = 2 pi sqrt(I / (m g GM)) of the hull about its long axis; the arm adds some per cent."""
    hull = REFERENCE.hull
    inertia = hull.inertia_kg_m2[0][0] + hull.added_mass[3][3]
    alone = 2.0 * np.pi * np.sqrt(inertia / (hull.mass_kg * 9.81 * hull.cg_m[2]))
    found = natural_periods(REFERENCE, np.radians(REFERENCE.arm.stowed_deg)).roll_s
    assert found == pytest.approx(alone, rel=0.1)
