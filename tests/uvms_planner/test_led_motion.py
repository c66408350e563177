"""The tool led by targets that come one by one."""

import numpy as np
import pytest
from planner_rig import assert_smooth, assert_within_limits, drive
from test_preemption import GOALS

from uvms_core.vehicle import load_vehicle
from uvms_planner import GoalRejected
from uvms_planner.led_motion import Approach


def tool(run):
    return run.references[-1].end_effector[-1]


@pytest.mark.parametrize("vehicle", ["reference_auv", "bluerov2_alpha5"])
def test_the_tool_comes_to_rest_at_the_last_target(vehicle):
    """Set-points on a helix, some of them two in one step of the planner."""
    run = drive(load_vehicle(vehicle))
    start = tool(run)
    angles = np.linspace(0.0, 3.0, 16)
    for k, angle in enumerate(angles):
        target = start + 0.1 * np.array([np.cos(angle) - 1.0, np.sin(angle), 0.3 * angle])
        run.planner.lead(target)
        if k % 3:
            run.advance()
    run.advance(20)
    np.testing.assert_allclose(tool(run), target, atol=1e-6)
    last = run.references[-1]
    assert np.abs(last.nu[-1]).max() < 1e-9
    assert np.abs(last.q_dot[-1]).max() < 1e-9
    assert_smooth(run)
    assert_within_limits(run)


def test_the_way_is_the_quintic_of_a_jump_from_motion_to_rest():
    start = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.0, -0.1]), np.array([0.0, 0.02, 0.0])
    target = np.array([1.5, 1.0, 3.2])
    way = Approach.of(start, target, 8.0)
    found = way.samples(np.array([0.0, 8.0, 100.0]))
    for part, begin, end in zip(found[:3], start, (target, np.zeros(3), np.zeros(3)), strict=True):
        np.testing.assert_allclose(part[0], begin, atol=1e-12)
        np.testing.assert_allclose(part[1:], np.stack([end, end]), atol=1e-12)


def test_a_far_target_is_gone_to_within_the_limits():
    run = drive()
    target = tool(run) + [4.0, -2.0, 1.0]
    run.planner.lead(target)
    run.advance(200)
    np.testing.assert_allclose(tool(run), target, atol=1e-6)
    assert_within_limits(run)


def test_what_cannot_be_reached_leaves_the_motion_as_it_was():
    run, other = drive(limits={"depth_max_m": 10.5}), drive(limits={"depth_max_m": 10.5})
    for each in (run, other):
        each.planner.lead(tool(each) + [0.3, 0.0, 0.0])
        each.advance(3)
    with pytest.raises(GoalRejected, match=r"target: no motion to .*; z of the vehicle"):
        run.planner.lead(tool(run) + [0.0, 0.0, 5.0])
    with pytest.raises(GoalRejected, match="it must be three finite numbers"):
        run.planner.lead(np.array([np.nan, 0.0, 0.0]))
    for each in (run, other):
        each.advance(10)
    np.testing.assert_array_equal(run.joined("q"), other.joined("q"))


def test_a_goal_takes_over_from_a_target_and_targets_wait_for_its_end():
    run = drive()
    run.planner.lead(tool(run) + [0.5, 0.0, 0.0])
    run.advance(4)
    run.planner.accept(GOALS["joints"](run))
    with pytest.raises(GoalRejected, match="target: a goal is active"):
        run.planner.lead(tool(run))
    assert run.until_finished().success
    assert_smooth(run)
    assert_within_limits(run)
    run.planner.lead(tool(run))
