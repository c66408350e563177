"""What the terminal shows against the signals of a loop that flies."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from uvms_analysis.log.encode import SignalWriter
from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_bringup.simulate import write_tick
from uvms_bringup.terminal.heard_log import HeardLog
from uvms_bringup.terminal.listener import EVENTS, Listener
from uvms_core import diagnostics, topics
from uvms_core.description import StateFrames
from uvms_core.diagnostics import Status
from uvms_core.signals import to_nanoseconds

TICKS = 50
NAMESPACE = "auv"


@pytest.fixture(scope="module")
def flown():
    """Scenario, vehicle, and the ticks of a hover."""
    scenario = load_scenario("hover")
    vehicle = scenario.load_vehicle()
    loop = Loop(scenario.for_vehicle(vehicle), vehicle)
    ticks = []
    for _ in range(TICKS):
        ticks.append(loop.tick())
        loop.advance(ticks[-1])
    return scenario, vehicle, ticks


@pytest.fixture
def heard(flown, tmp_path):
    """A listener and the writer of the log that it hears; nothing has been written."""
    scenario, vehicle, _ = flown
    listener = Listener(vehicle, scenario.planner.limits, NAMESPACE)
    with HeardLog(tmp_path / "run.mcap", listener.hear) as log:
        names = vehicle.joint_names, vehicle.thruster_names
        yield listener, SignalWriter(log, *names, NAMESPACE)


@pytest.fixture
def at_end(flown, heard):
    """The same, with all ticks written; and the last tick."""
    _, vehicle, ticks = flown
    listener, writer = heard
    for tick in ticks:
        write_tick(writer, tick, StateFrames(vehicle))
    return listener, writer, ticks[-1]


def test_nothing_is_known_before_anything_has_come(heard, flown):
    measured = heard[0].measured(0)
    assert measured.tool.value is measured.roll.value is measured.pitch.value is None
    assert measured.restoring is measured.coupling is measured.external is measured.health is None
    assert [each.thrust for each in measured.thrusters] == [None] * len(flown[1].thrusters)


def test_attitude_thrust_and_disturbance_are_those_of_the_tick(at_end):
    listener, _, tick = at_end
    measured = listener.measured(tick.stamp)
    _, pitch, roll = Rotation.from_quat(tick.odometry.quaternion).as_euler("ZYX", degrees=True)
    assert measured.roll.value == pytest.approx(roll, abs=1e-9)
    assert measured.pitch.value == pytest.approx(pitch, abs=1e-9)
    applied = tick.newest(topics.APPLIED_THRUST).thrust
    assert [each.thrust for each in measured.thrusters] == pytest.approx(list(applied))
    assert measured.external.force == pytest.approx(np.linalg.norm(tick.budget.external[:3]))
    assert measured.coupling.moment == pytest.approx(np.linalg.norm(tick.budget.coupling[3:]))
    assert measured.health.words == "ok"


def test_the_battery_is_shown_between_its_samples_and_forgotten_after_them(at_end, flown):
    listener, _, last = at_end
    said = [tick.truth.battery for tick in flown[2] if tick.truth.battery is not None]
    assert [each.stamp for each in said] == [0, 10**9, 2 * 10**9]
    battery = listener.measured(last.stamp).battery
    assert (battery.share, battery.voltage) == (said[-1].percentage, said[-1].voltage)
    assert battery.power == pytest.approx(said[-1].power)
    assert listener.measured(said[-1].stamp + 3 * 10**9).battery is None


@pytest.mark.parametrize("shift_mm", [(0.0, 0.0, 0.0), (3.0, -4.0, 0.0), (0.0, 0.0, 300.0)])
def test_the_tool_is_off_by_as_much_as_the_vehicle_on_its_plan_is_shifted(flown, heard, shift_mm):
    reference = next(
        found for tick in flown[2] if (found := tick.newest(topics.REFERENCE)) is not None
    )
    tick = next(tick for tick in flown[2] if tick.stamp >= reference.stamp)
    listener, writer = heard
    moved = replace(
        tick.odometry,
        stamp=reference.stamp,
        position=reference.position[0] + 1e-3 * np.array(shift_mm),
        quaternion=reference.quaternion[0],
    )
    joints = replace(tick.sensors.joints, stamp=reference.stamp, position=reference.q[0])
    later = replace(reference, stamp=reference.end, end_effector=reference.end_effector + 1.0)
    for topic, signal in (
        (topics.REFERENCE, reference),
        (topics.ODOMETRY, moved),
        (topics.JOINT_STATES, joints),
        (topics.REFERENCE, later),  # has not begun, and does not count
    ):
        writer.write(topic, signal)
    tool = listener.measured(reference.stamp).tool
    assert tool.value == pytest.approx(np.linalg.norm(shift_mm), abs=1e-6)
    assert tool.is_exceeded == (shift_mm[2] == 300.0)


def test_what_is_old_is_not_shown(at_end):
    listener, _, tick = at_end
    measured = listener.measured(tick.stamp + to_nanoseconds(1.5))
    assert measured.tool.value is measured.roll.value is measured.external is None
    assert {each.thrust for each in measured.thrusters} == {None}


def test_health_is_the_worst_that_is_said_now(at_end):
    listener, writer, tick = at_end

    def say(name, level, text):
        writer.write(topics.DIAGNOSTICS, Status(tick.stamp, name, level, text))
        return listener.measured(tick.stamp).health.words

    assert say("navigation", diagnostics.WARN, "no DVL") == "WARN navigation: no DVL"
    assert say("plant", diagnostics.ERROR, "late") == "ERROR plant: late"
    assert say("controller", diagnostics.OK, "ok") == "ERROR plant: late"
    assert say("plant", diagnostics.OK, "ok") == "WARN navigation: no DVL"
    assert say("navigation", diagnostics.OK, "ok") == "ok"


def test_the_last_events_of_the_plant_are_kept(at_end):
    listener, writer, tick = at_end
    for number in range(EVENTS + 1):
        values = {"event_at_s": float(number), "event_0": f"push {number}"}
        writer.write(topics.DIAGNOSTICS, Status(tick.stamp, topics.PLANT, values=values))
    expected = tuple((float(k), f"push {k}") for k in range(1, EVENTS + 1))
    assert listener.measured(tick.stamp).events == expected


def test_another_namespace_is_not_heard(flown, at_end, tmp_path):
    scenario, vehicle, _ = flown
    stranger = Listener(vehicle, scenario.planner.limits, "other")
    _, writer, tick = at_end
    for topic, signal in tick.outputs:
        if topic is topics.ODOMETRY:
            writer.write(topic, signal)
            stranger.hear(topic.resolve(NAMESPACE), signal.stamp, b"")
    assert stranger.measured(tick.stamp).roll.value is None
