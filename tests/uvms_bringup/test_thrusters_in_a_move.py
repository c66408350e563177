"""Moves and turns in a current: whole thrusters stay whole, and one that fails is named."""

import numpy as np
import pytest

from uvms_bringup.loop import Loop
from uvms_bringup.scenario import load_scenario


def believed(seed, current, pose, seconds, *settings):
    """Shares (k, m) that the allocator counts the thrusters with, and their names."""
    words = [f"goal.pose={pose}", f"plant.current_ned_m_s={current}", f"seed={seed}", *settings]
    scenario = load_scenario("hover", words, duration_s=seconds)
    vehicle = scenario.load_vehicle()
    loop, shares = Loop(scenario, vehicle), []
    goal = scenario.goal.build(vehicle, scenario.plant)
    while loop.plant.stamp < seconds * 1e9:
        tick = loop.tick()
        if tick.stamp == 0:
            loop.planner.accept(goal)
        if tick.allocation is not None and tick.allocation.effectiveness.size:
            shares.append(tick.allocation.effectiveness)
        loop.advance(tick)
    return np.array(shares), vehicle.thruster_names


@pytest.mark.parametrize(
    ("seed", "current", "pose", "seconds"),
    [
        (1, [-0.18, -0.05, 0.0], "{position_m: [2.4, 2.5, 0.5], yaw_deg: -77}", 10.0),
        (4, [0.15, -0.17, 0.0], "{position_m: [1.4, -3.5, 0.7], yaw_deg: -82}", 12.0),
        (9, [-0.05, 0.18, 0.0], "{position_m: [-3.9, 3.5, -0.7], yaw_deg: 124}", 8.0),
        (15, [-0.2, -0.03, 0.0], "{position_m: [-0.2, 3.7, 0.0], yaw_deg: -35}", 8.0),
        (2, [0.2, 0.1, 0.0], "{yaw_deg: 170}", 12.0),
        (3, [0.1, -0.2, 0.0], "{yaw_deg: -150}", 12.0),
        (5, [-0.15, 0.15, 0.0], "{yaw_deg: 135}", 12.0),
    ],
)
def test_what_a_current_does_to_a_hull_that_moves_is_no_fault(seed, current, pose, seconds):
    shares, _ = believed(seed, current, pose, seconds)
    assert len(shares) > 100
    assert (shares == 1.0).all()


@pytest.mark.parametrize(("name", "left"), [("side_fore", 0.0), ("side_aft", 0.4)])
def test_one_that_fails_in_a_turn_is_named_within_two_seconds(name, left):
    event = f"events=[{{at_s: 5.0, thruster: {name}, effectiveness: {left}}}]"
    pose = "{position_m: [1.4, -3.5, 0.7], yaw_deg: -82}"
    shares, names = believed(4, [0.15, -0.17, 0.0], pose, 7.0, event)
    i = names.index(name)
    assert shares[-1, i] == pytest.approx(left, abs=0.25)
    assert (np.delete(shares, i, axis=1) == 1.0).all()
