"""The reference vehicle sails straight: its fins hold it against Munk's moment.

The brakes hold the stowed arm, the main thruster pushes, nobody steers.
"""

import numpy as np
import pytest
from random_vehicles import REFERENCE

from uvms_core.signals import ThrusterCommand
from uvms_core.vehicle import load_vehicle
from uvms_dynamics import build_model, inverse_dynamics, mass_matrix, quat_to_rpy, rpy_to_quat
from uvms_dynamics.simulation import Plant, PlantConfig

STOWED = np.radians(REFERENCE.arm.stowed_deg)
BARE = load_vehicle(overrides={"hull.fins": []})


def sail(vehicle, thrust, seconds=60.0):
    """Positions (k, 3), attitudes (k, 3) in degrees and velocities (k, 6) from rest."""
    plant, samples = Plant(vehicle, PlantConfig(), seed=1), []
    command = np.eye(vehicle.n_thrusters)[0] * thrust
    while plant.stamp < seconds * 1e9:
        plant.step(ThrusterCommand(plant.stamp, command), None)
        odometry = plant.truth().odometry
        attitude = np.degrees(quat_to_rpy(odometry.quaternion))
        samples.append(np.concatenate([odometry.position, attitude, odometry.nu]))
    return np.split(np.array(samples), [3, 6], axis=1)


def pairs(vehicle, speed):
    """Largest growth, 1/s, of sway and yaw, and of heave, pitch rate and pitch."""
    model, h = build_model(vehicle), 1e-6
    inertia, still = mass_matrix(model, STOWED)[:6, :6], np.zeros(vehicle.n_joints)

    def rate(nu, pitch):
        quat = rpy_to_quat(0.0, pitch, 0.0)
        force = inverse_dynamics(model, quat, nu, np.zeros(6), STOWED, still, still)
        return np.linalg.solve(inertia, -force[:6])

    ahead = speed * np.eye(6)[0]
    slope = np.zeros((7, 7))
    for k in range(6):
        step = h * np.eye(6)[k]
        slope[:6, k] = (rate(ahead + step, 0.0) - rate(ahead - step, 0.0)) / (2.0 * h)
    slope[:6, 6] = (rate(ahead, h) - rate(ahead, -h)) / (2.0 * h)
    slope[6, 4] = 1.0
    level, upright = slope[np.ix_([1, 5], [1, 5])], slope[np.ix_([2, 4, 6], [2, 4, 6])]
    return np.linalg.eigvals(level).real.max(), np.linalg.eigvals(upright).real.max()


@pytest.mark.parametrize("speed", [0.1, 0.2, 0.5, 1.0, 1.5, 2.0])
def test_it_is_stable_on_a_straight_line(speed):
    sway_yaw, heave_pitch = pairs(REFERENCE, speed)
    assert sway_yaw < 0.0
    assert heave_pitch < 0.0


@pytest.mark.parametrize("speed", [0.5, 1.0, 2.0])
def test_without_fins_munks_moment_turns_it(speed):
    assert pairs(BARE, speed)[0] > 0.1


def test_the_hull_alone_has_half_as_much_of_the_rudders_as_stability_needs_again():
    """Without damping and arm: A x against (m + X) Munk / (Munk + m + X), see the vehicle file."""
    hull, water = REFERENCE.hull, REFERENCE.environment.water_density_kg_m3
    added = np.array(hull.added_mass)
    munk, mass = added[1, 1] - added[0, 0], hull.mass_kg + added[0, 0]
    rudders = [fin for fin in hull.fins if fin.normal[1]]
    moment = sum(-0.5 * water * f.area_m2 * f.slope * f.position_m[0] for f in rudders)
    needed = mass * munk / (munk + mass)
    assert needed == pytest.approx(88.5, abs=0.2)
    assert moment / needed == pytest.approx(1.5, abs=0.03)


@pytest.mark.parametrize("thrust", [27.0, 98.0])
def test_it_keeps_its_course_to_one_degree_for_a_minute(thrust):
    positions, attitudes, _ = sail(REFERENCE, thrust)
    assert np.abs(attitudes[:, 2]).max() < 1.0
    assert np.abs(positions[-1, 1]) < 2.0
    way = np.linalg.norm(np.diff(positions, axis=0), axis=1).sum()
    assert np.linalg.norm(positions[-1] - positions[0]) > 0.99 * way
    assert way > (55.0 if thrust < 50.0 else 115.0)


def test_the_main_thruster_drives_it_at_2_1_metres_a_second():
    _, _, velocities = sail(REFERENCE, 98.0)
    assert velocities[-1, 0] == pytest.approx(2.1, abs=0.01)
    assert np.degrees(np.abs(velocities[-1, 5])) < 0.05


def test_without_fins_it_circles():
    """As it did before it had any: an eighth of the way from its start."""
    positions, _, velocities = sail(BARE, 98.0, seconds=30.0)
    assert velocities[-1, 0] < 1.0
    assert np.degrees(abs(velocities[-1, 5])) > 15.0
    assert np.linalg.norm(positions[-1, :2]) < 12.0


@pytest.mark.parametrize(("degrees", "part"), [(5, 0.3), (15, 0.4), (30, 0.7), (45, 0.7)])
def test_hover_in_a_current_takes_less_of_a_moment_than_without_fins(degrees, part):
    """Yaw moment of the thrusters that hold it in 0.5 m/s, so far off the bow."""
    angle, still = np.radians(degrees), np.zeros(REFERENCE.n_joints)
    nu_r = np.array([0.5 * np.cos(angle), 0.5 * np.sin(angle), 0.0, 0.0, 0.0, 0.0])
    level = np.array([0.0, 0.0, 0.0, 1.0])
    with_fins, without = (
        inverse_dynamics(build_model(v), level, nu_r, np.zeros(6), STOWED, still, still)[5]
        for v in (REFERENCE, BARE)
    )
    assert without > 3.0
    assert 0.0 < with_fins < part * without
