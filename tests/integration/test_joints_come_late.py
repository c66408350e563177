"""Joint states that come late, in the closed loop: the vehicle stays level, and nothing stops."""

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario
from uvms_core import topics

BEGIN, END = 5.0, 9.0
"""The arm moves fast then, and with an acceleration followed too fast the loop would swing up."""


def flown(latency_s, until_s, observer):
    """Ticks of the arm's swing with encoders late from 5 s on."""
    event = {"at_s": BEGIN, "sensor": "encoders", "fault": "latency", "latency_s": latency_s}
    if until_s is not None:
        event["until_s"] = until_s
    scenario = load_scenario("arm_swing", [f"events={[event]}", f"observer={observer}"])
    vehicle = scenario.load_vehicle()
    loop = Loop(scenario, vehicle)
    goal = scenario.goal.build(vehicle, scenario.plant)
    ticks = []
    while loop.plant.stamp <= 1e9 * END:
        tick = loop.tick()
        if not ticks:
            loop.planner.accept(goal)  # it knows by now where the vehicle is
        ticks.append(tick)
        loop.advance(tick)
    return ticks


def rolls_deg(ticks):
    x, y, z, w = np.array([tick.truth.odometry.quaternion for tick in ticks]).T
    return np.degrees(np.arctan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)))


@pytest.mark.parametrize("latency_s", [0.05, 0.1, 0.2])
def test_the_vehicle_stays_as_level_as_with_joint_states_in_time(latency_s):
    ticks = flown(latency_s, None, "combined")
    late = [tick for tick in ticks if tick.stamp >= 1e9 * (BEGIN + latency_s)]
    assert {tick.stamp - tick.sensors.joints.stamp for tick in late} == {round(1e9 * latency_s)}
    assert np.abs(rolls_deg(ticks)).max() < 0.2


def test_older_ones_than_the_loop_stands_are_refused_until_newer_ones_come():
    ticks = flown(0.4, 6.0, "combined")
    moments = {round(1e-9 * tick.stamp, 3): np.abs(tick.wrench.wrench[3:]).max() for tick in ticks}
    # The joint state of 4.95 s serves here, and is older than what the loop stands from 5.2 s on.
    assert moments[5.15] > 0.0
    assert all(moments[t] == 0.0 for t in (5.3, 5.6, 5.9, 6.2))
    assert moments[6.6] > 0.0
    texts = [
        signal.message
        for tick in ticks
        for topic, signal in tick.outputs
        if topic is topics.DIAGNOSTICS and signal.name == topics.CONTROLLER
    ]
    assert any("joint_states: stamp" in text for text in texts)
