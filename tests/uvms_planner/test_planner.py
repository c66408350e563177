from dataclasses import replace

import numpy as np
import pytest
from planner_rig import (
    START,
    START_DEG,
    drive,
    joints,
    odometry,
    reference_vehicle,
    short_figure_9,
    six_joint_vehicle,
    stubby_vehicle,
)
from scipy.spatial.transform import Rotation

from uvms_core.end_effector_path import EndEffectorPath
from uvms_core.errors import SignalError
from uvms_core.signals import JointGoal, PathGoal, to_nanoseconds, to_seconds
from uvms_dynamics import end_effector
from uvms_planner import MotionPlanner, PathPhase, PathSpec, PlannerConfig

NONE = np.zeros((0, 4))


def followed(run, spec):
    """Drive a path to its end; returns (result, path, stamp of its start)."""
    goal = spec.goal(*run.planner.end_effector)
    run.planner.accept(goal)
    start = to_seconds(run.references[-1].end)
    return run.until_finished(), EndEffectorPath(goal), start


def self_disturbance(run):
    """Root mean square of force (N) and moment (N m) over the planned steps."""
    wrenches = np.array([s.step.self_disturbance for s in run.steps if s.step is not None])
    return np.sqrt(np.mean(np.sum(wrenches.reshape(-1, 2, 3) ** 2, axis=2), axis=0))


def test_the_first_tick_gives_the_hold_segment_and_the_next_and_then_one_each():
    run = drive()
    assert [r.stamp for r in run.references] == [0, to_nanoseconds(0.5)]
    run.advance(3)
    assert [len(step.references) for step in run.steps] == [2, 1, 1, 1]
    for first, second in zip(run.references, run.references[1:], strict=False):
        assert first.end == second.stamp
    for signal in run.references:
        assert np.allclose(signal.times, np.linspace(0.0, 0.5, 11))
        assert np.allclose(signal.position, [0.0, 0.0, 10.0])
        assert np.allclose(signal.q, np.deg2rad(START_DEG))
        assert not np.any(signal.nu)
        assert not np.any(signal.q_dot)
    assert run.steps[-1].diagnostics() == {}


def test_the_pose_that_is_held_is_level():
    planner = MotionPlanner(reference_vehicle(), PlannerConfig(), 1)
    tilted = Rotation.from_euler("ZYX", [0.8, 0.1, -0.05]).as_quat()
    step = planner.step(0, odometry(0, (1.0, 2.0, 3.0), tilted), joints())
    level = Rotation.from_euler("ZYX", [0.8, 0.0, 0.0]).as_quat()
    assert np.allclose(step.references[0].quaternion, level)
    assert np.allclose(step.references[0].position, [1.0, 2.0, 3.0])


@pytest.mark.parametrize("method", ["genetic", "genetic_steps", "least_norm", "arm_only"])
def test_references_are_smooth_within_limits_and_on_the_path_between_the_knots(method):
    run = drive(method=method)
    result, path, start = followed(run, short_figure_9())
    run.advance(4)
    assert result.success
    assert result.max_planned_error < 2e-5
    _assert_smooth(run)
    for signal in run.references:
        times = to_seconds(signal.stamp) + signal.times - start
        gap = signal.end_effector - path.positions(times)
        assert np.max(np.linalg.norm(gap, axis=1)) < 2e-5
        for k in range(0, 11, 5):
            tool, _ = end_effector(
                run.planner._solver.model, signal.position[k], signal.quaternion[k], signal.q[k]
            )
            assert np.allclose(tool, signal.end_effector[k], atol=1e-12)
    _assert_within_limits(run)
    last = run.references[-1]
    assert np.max(np.abs(last.nu)) < 1e-12
    assert np.max(np.abs(last.q_dot)) < 1e-12


def _assert_smooth(run):
    for first, second in zip(run.references, run.references[1:], strict=False):
        for name in ("position", "quaternion", "nu", "nu_dot", "q", "q_dot", "q_ddot"):
            assert np.allclose(getattr(first, name)[-1], getattr(second, name)[0], atol=1e-9), name
    dt = 0.05
    q, q_dot = run.joined("q"), run.joined("q_dot")
    mean = (q_dot[1:] + q_dot[:-1]) / 2 - dt / 12 * np.diff(run.joined("q_ddot"), axis=0)
    assert np.allclose(np.diff(q, axis=0) / dt, mean, atol=3e-5)


def _assert_within_limits(run):
    limits = run.planner._solver.limits
    yaw = 2 * np.unwrap(np.arctan2(run.joined("quaternion")[:, 2], run.joined("quaternion")[:, 3]))
    c = np.column_stack([run.joined("position"), yaw, run.joined("q")])
    assert np.all(limits.violation(c[::10]) < np.deg2rad(0.2))  # knots: within the margin
    joints = run.planner._solver.joints
    assert np.all(c[:, 4:] >= joints.lower)
    assert np.all(c[:, 4:] <= joints.upper)
    steps = np.diff(c[::10], axis=0)
    assert np.all(np.abs(steps) <= limits.reach + 1e-9)


def test_the_genetic_planner_disturbs_itself_far_less_than_the_arm_alone():
    spec = short_figure_9(seconds=40.0, scale=1.0)
    moments = {}
    for method in ("genetic", "least_norm", "arm_only"):
        run = drive(method=method)
        assert followed(run, spec)[0].success
        moments[method] = self_disturbance(run)[1]
        assert all(s.step.attitude_violation == 0.0 for s in run.steps if s.step)
    assert moments["genetic"] < 0.3 * moments["arm_only"]
    assert moments["genetic"] < 0.4 * moments["least_norm"]


def test_with_the_arm_alone_the_vehicle_holds_still():
    run = drive(method="arm_only")
    followed(run, short_figure_9())
    assert np.all(run.joined("nu") == 0.0)
    assert np.ptp(run.joined("position"), axis=0) == pytest.approx([0.0, 0.0, 0.0], abs=1e-15)


def test_the_same_seed_plans_the_same_and_another_does_not():
    def plan(seed):
        run = drive(seed=seed, method="genetic_steps", genetic={"refinements": 0, "generations": 4})
        run.planner.accept(short_figure_9().goal(*run.planner.end_effector))
        run.advance(10)
        return run.joined("q")

    assert np.array_equal(plan(3), plan(3))
    assert not np.array_equal(plan(3), plan(4))


def test_the_attitude_limits_bring_the_arm_back_and_are_told_until_then():
    run = drive(q_deg=(40.0, 20.0, 60.0, 0.0), limits={"translation_rate_m_s": 0.05})
    hold = PathSpec(phases=(PathPhase(duration_s=40.0),))
    assert followed(run, hold)[0].success
    violations = [s.step.attitude_violation for s in run.steps if s.step is not None]
    assert violations[0] > np.deg2rad(3.0)
    assert run.steps[2].diagnostics()["attitude_violation_deg"] > 3.0
    assert violations[-1] == 0.0
    assert np.all(np.diff(violations) <= 1e-9)


def test_late_joints_are_carried_to_the_tick():
    """The arm is held where it is by now, and not where it was."""
    planner, rate = MotionPlanner(reference_vehicle(), PlannerConfig(), 1), np.full(4, 0.1)
    late = replace(joints(stamp=to_nanoseconds(0.8)), velocity=rate)
    step = planner.step(to_nanoseconds(1.0), odometry(to_nanoseconds(1.0)), late)
    assert np.allclose(step.references[0].q, np.deg2rad(START_DEG) + 0.2 * rate)


def test_a_path_begins_with_the_first_segment_that_is_not_planned():
    run = drive()
    run.advance(2)
    run.planner.accept(short_figure_9().goal(*run.planner.end_effector))
    step = run.advance()
    assert step.feedback.elapsed == 0.0
    assert step.feedback.duration == 60.0
    assert step.feedback.stamp == to_nanoseconds(1.5)
    step = run.advance(3)
    assert step.feedback.elapsed == pytest.approx(1.0)
    result = run.until_finished()
    assert result.success
    assert run.tick * 0.5 == 62.0


def test_the_tracking_error_is_that_of_the_estimate():
    run = drive()
    phase = PathPhase(duration_s=20.0, to_m=(0.0, 0.0, 0.1))
    goal = PathSpec(phases=(phase,)).goal(*run.planner.end_effector)
    run.planner.accept(goal)
    step = run.advance(12)  # the estimate stays at the start
    wanted = EndEffectorPath(goal).sample(step.feedback.elapsed).position
    assert step.feedback.elapsed == 5.0
    gap = np.linalg.norm(wanted - goal.positions[0])
    assert step.feedback.tracking_error == pytest.approx(gap, rel=1e-6)
    assert step.feedback.planned_error < 1e-5


def test_a_path_that_begins_beside_the_tool_is_joined():
    run = drive()
    goal = short_figure_9().goal(*run.planner.end_effector)
    offset = PathGoal(goal.times, goal.positions + [0.03, 0.0, -0.02], NONE)
    run.planner.accept(offset)
    step = run.advance()
    assert step.feedback.planned_error == pytest.approx(np.hypot(0.03, 0.02), rel=0.02)
    assert run.until_finished().max_planned_error < 1e-4
    _assert_smooth(run)


def test_cancel_comes_to_rest_smoothly_and_another_goal_can_begin():
    run = drive()
    run.planner.accept(short_figure_9(10.0).goal(*run.planner.end_effector))
    run.advance(12)
    moving = run.references[-1]
    assert np.max(np.abs(moving.q_dot)) + np.max(np.abs(moving.nu)) > 1e-3
    run.planner.cancel()
    step = run.advance()
    assert (step.finished.success, step.finished.message) == (False, "cancelled")
    assert step.feedback is None
    goal = short_figure_9(10.0).goal(*run.planner.end_effector)
    run.planner.accept(goal)  # while it still brakes: begins at rest
    assert run.until_finished().success
    _assert_smooth(run)
    _assert_within_limits(run)


def test_cancel_without_a_goal_does_nothing():
    run = drive()
    run.planner.cancel()
    assert run.advance().finished is None


def test_late_ticks_are_caught_up_without_a_gap():
    run = drive()
    run.planner.accept(short_figure_9().goal(*run.planner.end_effector))
    step = run.planner.step(to_nanoseconds(2.0), odometry(), joints())
    assert [r.stamp for r in step.references] == [to_nanoseconds(t) for t in (1.0, 1.5, 2.0, 2.5)]


def test_the_joints_go_from_rest_to_rest_while_the_vehicle_holds():
    run = drive(q_deg=(0.0, 0.0, 135.0, 0.0))
    positions = np.deg2rad([[90.0, 0.0, 0.0, 0.0], [90.0, 0.0, 0.0, 0.0], [0.0, 0.0, 135.0, 0.0]])
    times = np.array([10.2, 14.0, 26.3])
    run.planner.accept(JointGoal(times, positions))
    result = run.until_finished()
    assert run.tick * 0.5 == 27.5
    run.advance(2)
    assert result.success
    _assert_smooth(run)
    assert np.all(run.joined("nu") == 0.0)
    at = np.arange(len(run.joined("q"))) * 0.05 - 1.0
    q, q_dot = run.joined("q"), run.joined("q_dot")
    for time, point in zip(times, positions, strict=True):
        index = round((time + 1.0) / 0.05)
        assert at[index] == pytest.approx(time)
        assert np.allclose(q[index], point, atol=1e-9)
        assert np.allclose(q_dot[index], 0.0, atol=1e-9)
    feedback = run.steps[10].feedback
    assert (feedback.elapsed, feedback.duration) == (4.0, 26.3)


def test_with_an_orientation_the_tool_keeps_it():
    run = drive()
    spec = PathSpec(
        phases=(PathPhase(duration_s=20.0, to_m=(0.05, 0.04, 0.08)),), keep_orientation=True
    )
    _, quaternion = run.planner.end_effector
    result, _, _ = followed(run, spec)
    assert result.success
    wanted = Rotation.from_quat(quaternion)
    for signal in run.references:
        for k in range(0, 11, 2):
            _, rotation = end_effector(
                run.planner._solver.model, signal.position[k], signal.quaternion[k], signal.q[k]
            )
            turn = (Rotation.from_matrix(rotation) * wanted.inv()).magnitude()
            assert np.rad2deg(turn) < 0.025  # a twentieth of the tolerance


@pytest.mark.parametrize("method", ["genetic", "least_norm"])
@pytest.mark.parametrize(
    ("make", "q_deg"),
    [
        (six_joint_vehicle, (0.0, 10.0, 115.0, 0.0, 10.0, 0.0)),
        (stubby_vehicle, (0.0, 10.0, 115.0, 0.0)),
    ],
)
def test_other_vehicles_and_arms_are_planned_for(make, q_deg, method):
    run = drive(make(), q_deg, method=method)
    result, _, _ = followed(run, short_figure_9(10.0, 0.2))
    assert result.success
    assert run.references[-1].q.shape == (11, len(q_deg))
    assert result.max_planned_error < 1e-4
    _assert_smooth(run)
    _assert_within_limits(run)


def test_a_plan_that_leaves_its_reach_is_given_up_and_says_so():
    run = drive(method="least_norm", limits={"joint_rate_fraction": 0.02})
    goal = PathSpec(phases=(PathPhase(duration_s=6.0, to_m=(0.0, 0.0, 0.04)),)).goal(
        *run.planner.end_effector
    )
    run.planner.accept(goal)
    run.advance(4)
    # what the check could not know: the vehicle must not go deeper any more
    run.planner._solver.limits.upper[2] = run.references[-1].position[-1, 2]
    run.planner._solver.limits.lower[4:] = run.references[-1].q[-1] - 1e-6
    run.planner._solver.limits.upper[4:] = run.references[-1].q[-1] + 1e-6
    result = run.until_finished()
    assert not result.success
    assert result.message.startswith("aborted at t = ")
    assert "m away, allowed 0.001 m" in result.message
    run.advance(8)
    assert np.max(np.abs(run.references[-1].nu)) < 1e-12


@pytest.mark.parametrize(
    ("stamp", "position", "q_deg", "message"),
    [
        (0, (0.0, 0.0, 1.0), START_DEG, "stamp is 0 ns; it must be after the last step's, 0 ns"),
        (1, (0.0, np.nan, 1.0), START_DEG, r"odometry\.position\[1\] is nan; it must be finite"),
        (1, (0.0, 1.0), START_DEG, r"odometry\.position has shape \(2,\); it must have \(3,\)"),
        (
            1,
            (0.0, 0.0, 1.0),
            (1.0, 2.0),
            r"position has shape \(2,\); it must have \(4,\) for swing",
        ),
    ],
)
def test_malformed_signals_are_refused(stamp, position, q_deg, message):
    run = drive()
    with pytest.raises(SignalError, match=message):
        run.planner.step(stamp, odometry(stamp, position), joints(q_deg, stamp))
    run.advance()  # nothing is lost


def test_before_the_first_step_the_end_effector_is_not_known():
    planner = MotionPlanner(reference_vehicle(), PlannerConfig(), 1)
    with pytest.raises(SignalError, match="no step yet, the end effector is not known"):
        _ = planner.end_effector


def test_the_start_of_the_next_goal_is_where_the_plan_ends():
    run = drive()
    position, quaternion = run.planner.end_effector
    tool, rotation = end_effector(
        run.planner._solver.model, START[:3], np.array([0.0, 0.0, 0.0, 1.0]), START[4:].copy()
    )
    assert np.allclose(position, tool)
    assert np.allclose(Rotation.from_quat(quaternion).as_matrix(), rotation)
