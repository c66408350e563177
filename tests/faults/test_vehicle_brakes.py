"""The arm in the safe state: brakes hold exactly, slip at their torque, and are released."""

import numpy as np
import pytest
from free_run import FreeRun
from random_vehicles import REFERENCE, changed, random_vehicle

from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.vehicle import Vehicle, load_vehicle, vehicle_from_data
from uvms_core.vehicle.statics import joint_loads
from uvms_dynamics.simulation import Plant, PlantConfig
from uvms_dynamics.simulation.integrator import JOINTS, make_scratch
from uvms_dynamics.simulation.plant.brakes import Brakes

STOWED = np.radians(REFERENCE.arm.stowed_deg)
TICK_S = 0.05


def with_brakes(vehicle: Vehicle, torques) -> Vehicle:
    data = vehicle.model_dump(mode="json")
    for joint, torque in zip(data["arm"]["joints"], torques, strict=True):
        joint["brake_nm"] = float(torque)
    return vehicle_from_data(data)


def plant_of(vehicle: Vehicle, **config) -> Plant:
    return Plant(vehicle, PlantConfig(initial_position_m=(0.0, 0.0, 10.0), **config), 1)


def safe(plant: Plant, seconds: float) -> np.ndarray:
    """Joint angles at the end of a time without any command."""
    for _ in range(round(seconds / TICK_S)):
        plant.step(None, None)
    return plant.truth().joints.position


@pytest.mark.parametrize("name", ["reference_auv", "bluerov2_alpha5"])
def test_every_posture_of_the_project_is_held(name, saw):
    """Out on the side the vehicle rolls, and the loads change with it."""
    vehicle = load_vehicle(name)
    for posture in ("stowed", *vehicle.arm.postures_deg):
        plant = plant_of(vehicle, initial_posture=posture)
        start = plant.truth().joints.position
        assert (safe(plant, 20.0) == start).all(), posture
        assert (plant.truth().joints.velocity == 0.0).all()
    saw(f"no joint command for 20 s, {name}", "its brakes hold each posture without any drift")


def test_at_80_per_cent_of_its_torque_a_brake_does_not_creep(saw):
    """Level and neutral, so that the load of the stowed arm stays what it is."""
    load = np.abs(joint_loads(REFERENCE, STOWED))
    plant = plant_of(with_brakes(REFERENCE, np.maximum(load / 0.8, 1.0)))
    assert (safe(plant, 120.0) == STOWED).all()
    saw("a joint at 80 % of its holding torque", "it has not moved after two minutes")


def test_beyond_its_torque_a_brake_slips_and_the_others_hold():
    load = joint_loads(REFERENCE, STOWED)
    plant = plant_of(with_brakes(REFERENCE, [25.0, 25.0, 0.8 * abs(load[2]), 5.0]))
    moved = safe(plant, 2.0) - STOWED
    assert moved[2] * load[2] > 0.0  # the way of its load
    assert abs(np.degrees(moved[2])) > 0.1
    assert (moved[[0, 1, 3]] == 0.0).all()


def test_a_joint_without_a_brake_moves_as_with_a_command_of_no_torque():
    free = with_brakes(REFERENCE, np.zeros(4))
    silent, commanded = plant_of(free), plant_of(free)
    safe(silent, 2.0)
    for _ in range(40):
        stamp = commanded.stamp
        commanded.step(ThrusterCommand(stamp, np.zeros(7)), JointCommand(stamp, np.zeros(4)))
    np.testing.assert_array_equal(silent.truth().joints.position, commanded.truth().joints.position)
    assert np.abs(np.degrees(silent.truth().joints.position - STOWED)).max() > 1.0


def test_a_command_releases_the_brakes():
    """After that the plant is one that never had brakes."""
    braked, free = plant_of(REFERENCE), plant_of(with_brakes(REFERENCE, np.zeros(4)))
    safe(braked, 1.0)  # neutral and level: nothing has moved
    for plant in (braked, free):
        for k in range(60):
            effort = np.array([2.0, 3.0, -1.0, 0.5]) * np.sin(0.1 * k)
            stamp = plant.stamp
            plant.step(ThrusterCommand(stamp, np.zeros(7)), JointCommand(stamp, effort))
    a, b = braked.truth(), free.truth()
    np.testing.assert_allclose(a.joints.position, b.joints.position, atol=1e-11)
    np.testing.assert_allclose(a.odometry.nu, b.odometry.nu, atol=1e-11)
    assert np.abs(a.joints.velocity).max() > 0.01


def test_thrust_goes_on_while_the_arm_is_braked():
    plant = plant_of(REFERENCE)
    for _ in range(40):
        plant.step(ThrusterCommand(plant.stamp, np.array([50.0, 0, 0, 0, 0, 0, 0])), None)
    truth = plant.truth()
    assert truth.odometry.nu[0] > 0.2
    assert (truth.joints.position == STOWED).all()
    assert (truth.applied.thruster_safe, truth.applied.joint_safe) == (False, True)


def braked_states(run: FreeRun, duration: float, step: float) -> np.ndarray:
    """States (k+1, nx) of a free run with its brakes engaged."""
    x, scratch = run.state.copy(), make_scratch(run.system)
    states = np.empty((round(duration / step) + 1, len(x)))
    brakes = Brakes(run.vehicle, run.system, scratch)
    brakes.advance(x, run.thrust, step, states, np.empty_like(states), 0.0)
    return states


@pytest.mark.parametrize("seed", range(5))
def test_what_a_slipping_brake_takes_is_its_torque_times_its_way(seed):
    """Without water, weight, friction and stops all energy that is lost went into the brake."""
    free = changed(random_vehicle(seed, 1), water=False, gravity=False)
    run = FreeRun(with_brakes(free, [2.0]), seed, rates=1.0)
    states = braked_states(run, 6.0, 0.002)
    q, q_dot = states[:, JOINTS], states[:, JOINTS + 1]
    assert q_dot[0] != 0.0
    way = np.abs(np.diff(q)).sum()
    lost = run.kinetic(states[0]) - run.kinetic(states[-1])
    assert lost == pytest.approx(2.0 * way, rel=1e-6)
    momentum = [run.momentum(x) for x in (states[0], states[-1])]
    np.testing.assert_allclose(*momentum, atol=1e-6 * np.abs(momentum[0]).max())


@pytest.mark.parametrize("n", [1, 3, 6])
@pytest.mark.parametrize("seed", range(3))
def test_brakes_never_add_energy(seed, n, saw):
    """Random arms thrown about, with brakes from feeble to strong; water takes energy as well."""
    rng = np.random.default_rng(seed)
    vehicle = with_brakes(random_vehicle(seed, n), 10.0 ** rng.uniform(-1.0, 2.5, n))
    run = FreeRun(vehicle, seed, rates=0.5)
    states = braked_states(run, 4.0, 0.002)
    energy = np.array([run.energy(x) for x in states])
    assert np.isfinite(states).all()
    assert np.diff(energy).max() < 1e-7 * np.ptp(energy)


@pytest.mark.parametrize("step", [0.005, 0.001])
def test_where_a_joint_stops_does_not_depend_on_the_step(step):
    """The end of the slip is found within a step: the order of the integrator is kept."""
    free = changed(random_vehicle(2, 2), water=False, gravity=False)
    run = FreeRun(with_brakes(free, [4.0, 4.0]), 2, rates=0.5)
    fine = braked_states(run, 2.0, 2.5e-4)[-1]
    found = braked_states(run, 2.0, step)[-1]
    np.testing.assert_allclose(found[JOINTS : JOINTS + 2], fine[JOINTS : JOINTS + 2], atol=2e-6)
