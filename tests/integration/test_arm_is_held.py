"""Without odometry the arm stays where it is: on the plant, hull adrift, by its joints alone."""

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_control import ControlConfig
from uvms_control.parts import ControllerPart
from uvms_core import topics
from uvms_core.signals import JointCommand, ThrusterCommand
from uvms_core.tick_gate import Tick
from uvms_core.vehicle import load_vehicle
from uvms_dynamics.simulation import Plant

LOST_S = 5.0
PERIOD = 50_000_000


def seen(plant):
    return plant.sense().joints, plant.truth().joints


def blind(stamp, joints):
    """A tick of the controller to which only the joints have come."""
    inputs = {topics.ODOMETRY.name: None, topics.JOINT_STATES.name: joints}
    return Tick(stamp, inputs, (topics.ODOMETRY.name,))


def safe_commands(part, stamp, joints):
    wrench, command = (signal for _, signal in part.safe(blind(stamp, joints)))
    return wrench.wrench, command


def adrift(plant, vehicle, torque, seconds):
    """Degrees (k, n) that the true joints move while no thruster does anything."""
    angles, nothing = [], np.zeros(vehicle.n_thrusters)
    for _ in range(round(seconds * 1e9 / PERIOD)):
        joints, true = seen(plant)
        angles.append(true.position)
        plant.step(ThrusterCommand(plant.stamp, nothing), torque(plant.stamp, joints))
    return np.degrees(np.array(angles) - angles[0])


def floating(name, posture):
    vehicle = load_vehicle(name)
    scenario = load_scenario("hover", [f"plant.initial_posture={posture}"]).for_vehicle(vehicle)
    return vehicle, Plant(vehicle, scenario.plant, seed=1)


@pytest.mark.parametrize(
    ("name", "posture"),
    [
        ("reference_auv", "home"),
        ("reference_auv", "extended_starboard"),
        ("bluerov2_alpha5", "home"),
    ],
)
@pytest.mark.parametrize("law", ["default", "test_arm_is_held:NoHold"])
def test_from_the_start_it_is_held_where_it_is(name, posture, law):
    vehicle, plant = floating(name, posture)
    part = ControllerPart(vehicle, ControlConfig(law=law), PERIOD)

    def held(stamp, joints):
        wrench, command = safe_commands(part, stamp, joints)
        assert not wrench.any()
        return command

    moved = adrift(plant, vehicle, held, LOST_S)
    assert np.abs(moved).max() < 1.0
    assert np.abs(moved[-1]).max() < 0.2
    assert part.left_to_reader == ()


@pytest.mark.parametrize("posture", ["home", "extended_starboard"])
def test_without_torque_it_sags(posture):
    vehicle, plant = floating("reference_auv", posture)
    none = lambda stamp, joints: JointCommand(stamp, np.zeros(vehicle.n_joints))  # noqa: E731
    assert np.abs(adrift(plant, vehicle, none, LOST_S)).max() > 20.0


class NoHold:
    """A law of somebody else's, who did not think of lost odometry."""

    def __init__(self, vehicle, config):
        pass

    def step(self, odometry, joints, disturbance, reference):
        raise NotImplementedError


@pytest.fixture
def swinging():
    """A loop in the middle of the arm's swing, with the commands of its last tick."""
    scenario = load_scenario("arm_swing")
    vehicle = scenario.load_vehicle()
    loop = Loop(scenario, vehicle)
    while True:
        tick = loop.tick()
        if tick.stamp == 0:
            loop.planner.accept(scenario.goal.build(vehicle, scenario.plant))
        loop.advance(tick)
        if tick.stamp >= 1e9 * LOST_S:
            return loop, vehicle, tick


def test_an_arm_in_motion_is_stopped_without_a_step_of_its_torques(swinging):
    loop, vehicle, last = swinging
    part, efforts = loop.parts[topics.CONTROLLER], [last.joint_command.effort]

    def held(stamp, joints):
        command = safe_commands(part, stamp, joints)[1]
        efforts.append(command.effort)
        return command

    rate = np.degrees(np.abs(seen(loop.plant)[1].velocity).max())
    assert rate > 10.0
    moved = np.abs(adrift(loop.plant, vehicle, held, LOST_S)).max(axis=1)
    assert moved.max() < rate / 4.0  # it stops within a quarter of a second's way
    assert np.ptp(moved[40:]) < 0.5
    inertia = part.law.arm.joints.gains.inertia * part.law.arm.joints.gains.bandwidth
    braking = inertia * np.abs(last.truth.joints.velocity)  # S w q_dot, what stops a joint
    assert (np.abs(efforts[1] - efforts[0]) < 2.0 * braking + 0.5).all()


def test_the_law_goes_on_where_the_hold_ends(swinging):
    """Odometry is away for two seconds: the plan has gone on, and the arm catches up with it."""
    loop, _, _ = swinging
    part = loop.parts[topics.CONTROLLER]
    for _ in range(40):
        joints, _ = seen(loop.plant)
        _, command = safe_commands(part, loop.plant.stamp, joints)
        loop.plant.step(None, command)
    reference = None
    while loop.plant.stamp < 1e9 * 14.0:
        tick = loop.tick()
        reference = tick.newest(topics.REFERENCE) or reference
        loop.advance(tick)
    error = np.degrees(tick.truth.joints.position - reference.q[-1])
    assert np.abs(error).max() < 1.0


def test_joint_states_that_are_too_old_hold_nothing():
    vehicle, plant = floating("reference_auv", "home")
    part, (joints, _) = ControllerPart(vehicle, ControlConfig(), PERIOD), seen(plant)
    assert safe_commands(part, 0, joints)[1].effort.any()
    assert safe_commands(part, 200_000_000, joints)[1].effort.any()
    assert not safe_commands(part, 400_000_000, joints)[1].effort.any()
    assert part.left_to_reader == (topics.JOINT_COMMAND,)  # the brakes hold better
    assert not safe_commands(part, 450_000_000, None)[1].effort.any()
