"""What made other simulators blow up: each run stays finite, and within the energy put into it."""

import numpy as np
import pytest
from free_run import FreeRun
from random_vehicles import REFERENCE, random_vehicle

from uvms_core.vehicle import vehicle_from_data
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.integrator import QUATERNION, VELOCITY
from uvms_dynamics.simulation.plant.stability import greatest_step


def edited(change):
    data = REFERENCE.model_dump(mode="json")
    change(data)
    return vehicle_from_data(data)


def bodies(data):
    return [data["hull"], *data["arm"]["links"]]


def heavy_water(data):
    """Ten times the mass along every axis, and ten times the inertia about every one."""
    for body in bodies(data):
        mass, inertia = body["mass_kg"], body["inertia_kg_m2"]
        body["added_mass"] = np.zeros((6, 6)).tolist()
        for k in range(3):
            body["added_mass"][k][k] = 10.0 * mass
            body["added_mass"][3 + k][3 + k] = 10.0 * inertia[k][k]


def light_arm(data):
    """A tenth of the mass of the water that it moves, and a hundredth of its added mass."""
    for link in data["arm"]["links"]:
        factor = 0.1 * 1025.0 * link["volume_m3"] / link["mass_kg"]
        link["mass_kg"] *= factor
        link["inertia_kg_m2"] = (factor * np.array(link["inertia_kg_m2"])).tolist()
    for joint in data["arm"]["joints"]:
        joint["rotor_inertia_kg_m2"] *= 0.1


def feather_in_heavy_water(data):
    light_arm(data)
    heavy_water(data)


VEHICLES = {
    "as it is": lambda data: None,
    "added mass ten times the mass": heavy_water,
    "arm a tenth of its water": light_arm,
    "both": feather_in_heavy_water,
}
CURRENTS = [(0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (-1.8, 2.4, 0.0)]


def assert_within_its_energy(run, duration):
    """Energy in the water's frame: never above the start's and the work of drives and thrusters.

    At 5 ms or, where the plant would refuse that, near its own bound. The work is summed by
    trapezoids; neutral or not, a level current does no work on the weight.
    """
    config = PlantConfig(current_ned_m_s=tuple(run.current))
    step = min(config.step_s, 0.9 * greatest_step(run.vehicle, config).step_s)
    states = run.go(duration, step)
    assert np.isfinite(states).all()
    power, every = run.power(states), round(0.1 / step)
    work = np.concatenate([[0.0], np.cumsum(0.5 * step * (power[1:] + power[:-1]))])
    energy = np.array([run.energy(x) for x in states[::every]])
    given = energy[0] + work[::every]
    scale = max(np.ptp(energy), np.ptp(work), 1.0)
    assert (energy - given).max() < 0.01 * scale
    return states


@pytest.mark.parametrize("current", CURRENTS, ids=str)
@pytest.mark.parametrize("name", VEHICLES)
def test_at_rest_over_ground_in_a_current(name, current):
    run = FreeRun(edited(VEHICLES[name]), 1, current, rates=0.0)
    drift = rotation_of(run.state).T @ np.array(current)
    run.state[VELOCITY : VELOCITY + 3] = -drift
    states = assert_within_its_energy(run, 20.0)
    speed = np.linalg.norm(states[:, VELOCITY : VELOCITY + 3], axis=1)
    assert speed[-1] < max(1.5, 0.5 * speed[0])  # the water takes it along, or it floats up


def rotation_of(state):
    x, y, z, w = state[QUATERNION:VELOCITY]
    e = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * w * e + 2.0 * e @ e


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("name", VEHICLES)
def test_all_drives_push_their_joints_into_the_stops(name, sign):
    """From anywhere at full torque, and against the stops for the rest of a minute."""
    vehicle = edited(VEHICLES[name])
    run = FreeRun(vehicle, 2, (0.0, 3.0, 0.0))
    joints = vehicle.arm.joints
    run.state[13 : 13 + run.n] = np.radians(vehicle.arm.stowed_deg)
    run.effort = sign * np.array([joint.effort_limit_nm for joint in joints])
    states = assert_within_its_energy(run, 60.0)
    end = np.radians([j.upper_deg if sign > 0.0 else j.lower_deg for j in joints])
    depth = sign * (states[-1, 13 : 13 + run.n] - end)
    assert (depth > 0.0).all()
    stiffness = np.array([joint.stop_stiffness_nm_rad for joint in joints])
    assert (depth < 1.5 * np.abs(run.effort) / stiffness + 1e-3).all()


@pytest.mark.parametrize("n", [1, 4, 8])
def test_random_arms_at_full_thrust_in_a_current(n):
    for seed in range(2):
        run = FreeRun(random_vehicle(seed, n), seed, (3.0, 0.0, 0.0), rates=2.0)
        run.thrust = np.array([thruster.limit_n for thruster in run.vehicle.thrusters])
        run.state[-len(run.thrust) :] = run.thrust
        assert_within_its_energy(run, 5.0)
