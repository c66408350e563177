"""A new goal in the place of another: planned beside it, begun smoothly, or refused untouched."""

import numpy as np
import pytest
from planner_rig import CALM, assert_smooth, assert_within_limits, drive, short_figure_9

from uvms_core.signals import DisturbanceBudget, JointGoal, PathGoal, Payload, PoseGoal
from uvms_planner import GoalRejected
from uvms_planner.planner import PREEMPTED

NONE = np.zeros((0, 4))
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])


def rise(run, seconds=20.0, height=0.15) -> PathGoal:
    """From where the next goal would begin, upwards."""
    position, _ = run.planner.end_effector
    s = np.linspace(0.0, 1.0, 21)
    blend = s**3 * (10 - 15 * s + 6 * s**2)
    positions = position + blend[:, None] * np.array([0.0, 0.0, -height])
    return PathGoal(s * seconds, positions, NONE)


def elsewhere(run) -> PoseGoal:
    return PoseGoal(run.references[-1].position[-1] + [0.6, 0.3, 0.1], LEVEL)


def folded(run) -> JointGoal:
    return JointGoal(np.array([15.0]), np.deg2rad([[10.0, 20.0, 100.0, 0.0]]))


GOALS = {"path": rise, "pose": elsewhere, "joints": folded}


@pytest.mark.parametrize("second", GOALS)
@pytest.mark.parametrize("first", GOALS)
def test_a_new_goal_ends_the_one_before_and_begins_from_its_smooth_stop(first, second):
    run = drive(limits=CALM)
    run.planner.accept(GOALS[first](run))
    run.advance(14)
    moving = run.references[-1]
    assert max(np.abs(moving.nu).max(), np.abs(moving.q_dot).max()) > 1e-3
    run.planner.accept(GOALS[second](run))
    step = run.advance()
    assert (step.finished.success, step.finished.message) == (False, PREEMPTED)
    assert step.feedback.elapsed == 0.0
    result = run.until_finished()
    run.advance(2)
    assert result.success
    assert_smooth(run)
    assert_within_limits(run)
    assert not np.abs(run.references[-1].nu).max() > 1e-9


def test_a_method_that_plans_step_by_step_changes_over_as_well():
    run = drive(limits=CALM, method="least_norm")
    run.planner.accept(rise(run))
    run.advance(12)
    run.planner.accept(rise(run, height=-0.1))
    assert run.advance().finished.message == PREEMPTED
    assert run.until_finished().success
    assert_smooth(run)
    assert_within_limits(run)


def test_what_is_planned_anew_for_a_payload_may_be_ended_by_a_new_path():
    """The way on is then that of the windows, which the whole path's plan does not know."""
    run, zero = drive(limits=CALM), np.zeros(6)
    run.planner.accept(rise(run, 40.0, 0.3))
    run.advance(12)
    payload = Payload(True, 1.0, 0.01, 4.0, 0.1, np.array([0.0, 0.0, 0.1]), np.full(3, 0.01))
    run.planner.inform(DisturbanceBudget(0, zero, zero, zero, zero, payload))
    run.advance(6)
    proposal = run.planner.propose(rise(run), 2.0)
    proposal.work(lambda share, text: None)
    run.advance(4)
    assert 0.0 < run.planner.lateness(proposal) < 0.05
    run.planner.begin(proposal)
    assert run.advance().finished.message == PREEMPTED
    assert run.until_finished().success
    assert_smooth(run)
    assert_within_limits(run)


@pytest.mark.parametrize("method", ["genetic", "least_norm"])
def test_a_path_that_is_refused_leaves_the_one_before_as_it_was(method):
    runs = [drive(method=method), drive(method=method)]
    for run in runs:
        run.planner.accept(rise(run))
        run.advance(10)
    position, _ = runs[1].planner.end_effector
    far = PathGoal(np.array([0.0, 5.0]), position + np.array([[0, 0, 0], [40.0, 0, 0]]), NONE)
    for bad in (far, PathGoal(np.array([0.0, 1.0]), np.zeros((2, 3)), NONE)):
        with pytest.raises(GoalRejected):
            runs[1].planner.accept(bad)
    with pytest.raises(GoalRejected):
        runs[1].planner.accept(PoseGoal(np.array([0.0, 0.0, -3.0]), LEVEL))
    results = [run.until_finished() for run in runs]
    assert results[0] == results[1]
    assert results[1].success
    for name in ("position", "q"):
        np.testing.assert_array_equal(runs[0].joined(name), runs[1].joined(name))


def test_the_one_before_goes_on_while_the_new_one_is_planned():
    run, alone = drive(limits=CALM), drive(limits=CALM)
    for each in (run, alone):
        each.planner.accept(rise(each))
        each.advance(10)
    proposal = run.planner.propose(rise(run))
    for each in (run, alone):
        each.advance(8)
    np.testing.assert_array_equal(run.joined("position"), alone.joined("position"))
    with pytest.raises(GoalRejected, match="another goal is being planned"):
        run.planner.accept(rise(run))
    proposal.work(lambda share, text: None)
    assert run.planner.lateness(proposal) > 1e-3
    run.planner.begin(proposal)
    assert run.advance().finished.message == PREEMPTED
    assert run.until_finished().success
    assert_smooth(run)
    assert_within_limits(run)


@pytest.mark.parametrize("first", GOALS)
def test_a_lead_that_is_right_leaves_no_way_back(first):
    run = drive(limits=CALM)
    run.planner.accept(GOALS[first](run))
    run.advance(6)
    goal = rise(run)
    proposal = run.planner.propose(goal, 2.0)
    proposal.work(lambda share, text: None)
    run.advance(4)
    assert run.planner.lateness(proposal) < 1e-9
    run.planner.begin(proposal)
    run.advance()
    assert run.until_finished().success
    assert_smooth(run)


def test_what_is_planned_may_begin_after_a_cancel_meanwhile():
    run = drive(limits=CALM)
    run.planner.accept(rise(run))
    run.advance(10)
    proposal = run.planner.propose(rise(run))
    proposal.work(lambda share, text: None)
    run.advance(4)
    run.planner.cancel()
    run.planner.begin(proposal)
    assert run.advance().finished.message == "cancelled"
    assert run.until_finished().success
    assert_smooth(run)


@pytest.mark.parametrize("second", GOALS)
def test_a_goal_begins_properly_while_the_vehicle_still_comes_to_rest(second):
    run = drive(limits=CALM)
    run.planner.accept(elsewhere(run))
    run.advance(14)
    run.planner.cancel()
    run.advance()
    assert np.abs(run.references[-1].nu).max() > 1e-3
    run.planner.accept(GOALS[second](run))
    assert run.until_finished().success
    assert_smooth(run)
    assert_within_limits(run)


def test_goals_that_end_in_one_tick_are_all_answered_in_order():
    run = drive(limits=CALM)
    run.planner.accept(elsewhere(run))
    run.advance(6)
    run.planner.accept(folded(run))
    run.planner.accept(elsewhere(run))
    run.planner.cancel()
    assert run.planner.answers_owed == 3
    told = [run.advance().finished.message for _ in range(3)]
    assert told == [PREEMPTED, PREEMPTED, "cancelled"]
    assert run.advance().finished is None
    assert not run.planner.has_goal
    run.advance(20)
    assert_smooth(run)


def test_a_path_may_begin_near_where_the_tool_is_while_it_moves():
    run = drive(limits=CALM, start_tolerance_m=0.02)
    run.planner.accept(PoseGoal(np.array([3.0, 0.0, 10.0]), LEVEL))
    run.advance(20)
    tool = run.references[-1].end_effector[-1]
    at_rest, _ = run.planner.end_effector
    assert np.linalg.norm(tool - at_rest) > 0.05
    s = np.linspace(0.0, 1.0, 31)
    positions = tool + (s**3 * (10 - 15 * s + 6 * s**2))[:, None] * [0.3, 0.0, 0.0]
    run.planner.accept(PathGoal(60.0 * s, positions, NONE))
    assert run.until_finished().message == PREEMPTED
    assert run.until_finished().success
    assert_smooth(run)
    np.testing.assert_allclose(run.references[-1].end_effector[-1], positions[-1], atol=1e-4)


def test_a_restart_while_a_path_is_planned_is_told():
    run, other = drive(), drive()
    proposal = run.planner.propose(short_figure_9(5.0).goal(*run.planner.end_effector))
    proposal.work(lambda share, text: None)
    with pytest.raises(GoalRejected, match="restarted while"):
        other.planner.begin(proposal)
