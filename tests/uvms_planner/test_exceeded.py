"""A step beyond the planned limits says so; where they are strict it is not taken."""

import numpy as np
import pytest
from planner_rig import CALM, START, drive, solver_of, target_near

from uvms_analysis.counters import COUNTED
from uvms_core.diagnostics import STEPS_BEYOND_LIMITS
from uvms_planner import PathSpec
from uvms_planner.exceeded import limits_exceeded

JOINTS = ("swing", "shoulder", "elbow", "wrist")
METHODS = ("genetic_steps", "least_norm", "sqp")
SUDDEN = [0.015, 0.0, 0.0]  # m in a first step: within the rates, not the accelerations


def sudden(solver):
    return solver.problem(START, np.zeros(8), target_near(solver, START, SUDDEN))


def test_a_step_within_the_limits_exceeds_none():
    solver = solver_of(limits=CALM)
    problem = solver.problem(START, np.zeros(8), target_near(solver, START, [0.0, 0.0, 1e-3]))
    choice = solver.choose(problem, 0)
    assert choice.valid
    assert choice.limits_exceeded == ()
    assert limits_exceeded(problem, problem.upper, JOINTS) == ()
    assert limits_exceeded(problem, problem.lower, JOINTS) == ()


def test_each_acceleration_is_named_with_value_and_bound_the_worst_first():
    solver = solver_of(limits=CALM)
    problem = sudden(solver)
    increment = np.zeros(8)
    increment[0], increment[5] = 2.0 * problem.jump[0], -3.0 * problem.jump[5]
    first, second = limits_exceeded(problem, increment, JOINTS)
    assert (first.name, first.unit) == ("acceleration of shoulder", "deg/s^2")
    assert first.bound == pytest.approx(2.0)  # a fifth of the vehicle file's 10 deg/s^2
    assert first.value == pytest.approx(6.0)
    assert first.ratio == pytest.approx(3.0)
    assert (second.name, second.unit) == ("acceleration of x", "m/s^2")
    assert (second.value, second.bound) == pytest.approx((0.02, 0.01))
    assert str(second) == "acceleration of x 0.02 m/s^2, allowed 0.01 m/s^2"


def test_a_speed_that_cannot_stop_before_the_end_of_the_range_is_named():
    solver, configuration = solver_of(limits=CALM), START.copy()
    configuration[6] = solver.limits.upper[6] - 1e-3
    problem = solver.problem(
        configuration, np.zeros(8), target_near(solver, configuration, np.zeros(3))
    )
    increment = np.zeros(8)
    increment[6] = problem.upper[6] + 0.5 * (problem.jump[6] - problem.upper[6])
    (limit,) = limits_exceeded(problem, increment, JOINTS)
    assert limit.name == "speed of elbow before the end of its range"
    assert limit.value == pytest.approx(np.rad2deg(increment[6]) / 0.5)
    assert limit.bound == pytest.approx(np.rad2deg(problem.upper[6]) / 0.5)


@pytest.mark.parametrize("method", METHODS)
def test_where_limits_are_strict_the_step_is_refused_with_the_limits(method):
    solver = solver_of(method=method, limits=CALM)
    choice = solver.choose(sudden(solver), 0)
    assert not choice.valid
    assert choice.distance < 1e-3
    assert choice.limits_exceeded
    assert all(limit.ratio > 1.0 for limit in choice.limits_exceeded)
    assert solver.steps_beyond_limits == 0


@pytest.mark.parametrize("method", METHODS)
def test_where_they_are_not_it_is_taken_reported_and_counted(method):
    solver = solver_of(method=method, limits={**CALM, "strict": False})
    problem = sudden(solver)
    choice = solver.choose(problem, 0)
    assert choice.valid
    assert choice.limits_exceeded
    assert np.any(np.abs(choice.increment) > problem.jump)
    assert np.all(np.abs(choice.increment) <= problem.reach)
    assert solver.steps_beyond_limits == 1


def test_what_is_out_of_reach_at_any_acceleration_is_not_called_a_limit():
    solver = solver_of(limits={**CALM, "strict": False})
    problem = solver.problem(START, np.zeros(8), target_near(solver, START, [0.5, 0.0, 0.0]))
    choice = solver.choose(problem, 0)
    assert not choice.valid
    assert choice.limits_exceeded == ()
    assert solver.steps_beyond_limits == 0


def _hurried(strict):
    """A planner on 0.2 m ahead in 6 s, whose acceleration is 3.2 times the planned one.

    Only the vehicle can follow it: x'' is that of the quintic, 10 / sqrt(3) * 0.2 / 36 m/s^2.
    """
    run = drive(
        method="vehicle_only", limits={**CALM, "strict": strict, "translation_rate_m_s": 0.1}
    )
    spec = PathSpec.model_validate({"line": {"to_m": [0.2, 0.0, 0.0], "duration_s": 6.0}})
    run.planner.accept(spec.goal(*run.planner.end_effector))
    return run, run.until_finished()


def test_a_goal_that_takes_more_is_aborted_with_the_limit_and_the_time():
    run, result = _hurried(strict=True)
    assert not result.success
    assert "aborted at t = " in result.message
    assert "only beyond a limit: acceleration of x" in result.message
    assert "allowed 0.01 m/s^2" in result.message
    run.advance(40)
    assert not np.any(run.references[-1].nu)  # and it has come to rest


def test_or_followed_and_the_diagnostics_count_the_steps():
    run, result = _hurried(strict=False)
    assert result.success
    taken = [step.step for step in run.steps if step.step is not None]
    beyond = [step for step in taken if step.limits_exceeded]
    assert 0 < len(beyond) < len(taken)
    assert taken[-1].steps_beyond_limits == len(beyond)
    values = beyond[0].values()
    assert values["limits_exceeded"].startswith("acceleration of x ")
    within = next(step for step in taken if not step.limits_exceeded)
    assert within.values()["limits_exceeded"] == "none"
    assert taken[-1].values()[STEPS_BEYOND_LIMITS] == len(beyond)
    assert STEPS_BEYOND_LIMITS in COUNTED  # and so it stands in the summary of a run
