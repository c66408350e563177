"""The planner's actions on the whole graph: feedback, success, cancel, rejection."""

import numpy as np
import pytest
from action_msgs.msg import GoalStatus
from in_process import spin_until
from led_graph import running

from uvms_bringup.errors import RunError
from uvms_bringup.scenario import load_scenario
from uvms_core.signals import JointGoal, PathGoal, to_nanoseconds, to_seconds


def path_from_start(duration_s: float, offset: tuple[float, float, float]) -> PathGoal:
    scenario = load_scenario("manipulation")
    whole = scenario.goal.build(scenario.load_vehicle(), scenario.plant)
    s = np.linspace(0.0, 1.0, 9)
    blend = s**3 * (10 - 15 * s + 6 * s**2)
    positions = whole.positions[0] + blend[:, None] * np.array(offset)
    return PathGoal(s * duration_s, positions, np.zeros((0, 4)))


def test_a_path_is_followed_with_feedback_to_its_end(tmp_path):
    goal = path_from_start(4.0, (0.0, 0.0, 0.02))
    with running(tmp_path, 7.0, goal) as (spinner, conductor):
        spin_until(spinner, lambda: conductor.feedback is not None)
        assert conductor.feedback.duration == pytest.approx(4.0)
        spin_until(spinner, lambda: conductor.result is not None)
    assert conductor.result.success
    assert conductor.result.max_planned_error < 1e-3
    assert conductor.feedback.tracking_error < 0.02


def test_a_goal_can_be_cancelled_and_the_vehicle_comes_to_rest(tmp_path):
    goal = path_from_start(60.0, (0.0, 0.0, 0.1))
    with running(tmp_path, 60.0, goal) as (spinner, conductor):
        spin_until(spinner, lambda: conductor.stamp > to_nanoseconds(3.0))
        conductor.goal_handle.cancel_goal_async()
        spin_until(spinner, lambda: conductor.result is not None)
        ended = to_seconds(conductor.stamp)
        spin_until(spinner, lambda: conductor.arrived(to_nanoseconds(60.0)))
    assert conductor.result_status == GoalStatus.STATUS_CANCELED
    assert conductor.result.message == "cancelled"
    assert ended < to_seconds(conductor.stamp) == 60.0


def test_a_joint_goal_beyond_a_limit_is_rejected_by_name(tmp_path):
    goal = JointGoal(np.array([5.0]), np.deg2rad([[0.0, 0.0, 170.0, 0.0]]))
    with pytest.raises(RunError, match="elbow"):
        with running(tmp_path, 6.0, goal):
            pass
