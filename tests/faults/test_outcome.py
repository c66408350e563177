"""The limits of a run, judged from its log: real runs, and copies with one thing changed."""

from dataclasses import replace

import numpy as np
import pytest
from outcome_runs import (
    DURATION_S,
    capsized,
    edited,
    off_from,
    outcome_of,
    simulated,
)

from uvms_bringup.scenario import load_scenario
from uvms_core import topics

LONGEST_S = 120.0


SHIPPED = [
    ("hover", ()),
    ("hover", ("control.observer=false",)),
    ("hover", ("control.enabled=false",)),
    ("hover", ("vehicle=bluerov2_alpha5",)),
    ("arm_swing", ()),
    ("arm_swing", ("control.observer=false",)),
    ("arm_swing", ("control.enabled=false",)),
    ("manipulation", ("control.observer=false",)),
    ("manipulation", ("control.enabled=false",)),
    ("manipulation", ("planner.method=arm_only",)),
]


@pytest.mark.long
@pytest.mark.parametrize(("scenario", "settings"), SHIPPED)
def test_the_scenarios_that_come_with_the_project_are_completed(tmp_path, saw, scenario, settings):
    duration = min(load_scenario(scenario).duration_s, LONGEST_S)
    _, summary = simulated(tmp_path / "run", scenario, *settings, duration_s=duration)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    saw(" ".join((scenario, *settings)), "completed")


def test_a_capsized_vehicle_is_given_up(run, tmp_path, saw):
    path = edited(run, tmp_path, topics.TRUE_ODOMETRY, capsized(3 * 10**9, 148.0))
    outcome = outcome_of(path)
    assert outcome.word == "given up"
    assert outcome.reasons[0] == "roll or pitch beyond 30 deg from 3.00 s on, up to 148.0 deg"
    saw("a capsized vehicle (roll 148 deg)", f"given up: {outcome.reasons[0]}")


def test_a_vehicle_that_was_never_upright_is_given_up(run, tmp_path):
    path = edited(run, tmp_path, topics.TRUE_ODOMETRY, capsized(0, -100.0))
    assert outcome_of(path).reasons[0] == ("roll or pitch never came below 30 deg; least 100.0 deg")


def test_a_vehicle_that_is_not_controlled_may_roll_as_it_likes(uncontrolled, tmp_path):
    path = edited(uncontrolled, tmp_path, topics.TRUE_ODOMETRY, capsized(10**9, 148.0))
    assert outcome_of(path).completed


def test_an_arm_that_is_stuck_is_given_up(uncontrolled, tmp_path, saw):
    path = edited(
        uncontrolled,
        tmp_path,
        topics.TRUE_JOINT_STATES,
        lambda joints: replace(joints, position=joints.position + np.deg2rad([0, 40, 0, 0])),
    )
    outcome = outcome_of(path)
    assert outcome.word == "given up"
    assert "the joints were within 10 deg of their plan for 0% of the time" in outcome.reasons[0]
    saw("control off, and the arm is not where it should be", f"given up: {outcome.reasons[0]}")


def test_an_end_effector_that_is_never_near_its_path_is_given_up(run, tmp_path, saw):
    offset = np.array([0.0, 0.5, 0.0])
    path = edited(
        run,
        tmp_path,
        topics.TRUE_ODOMETRY,
        lambda odometry: replace(odometry, position=odometry.position + offset),
    )
    outcome = outcome_of(path)
    assert outcome.word == "given up"
    assert "the end effector was within 0.2 m of its path for 0% of the time" in outcome.reasons[0]
    saw("the end effector half a metre off", f"given up: {outcome.reasons[0]}")


@pytest.mark.parametrize(
    ("span", "metres", "says"),
    [
        ((22.0, 41.0), 9.8, "18.0 s without a break (bound 10 s)"),
        ((10.0, 21.0), 0.4, "10.9 s without a break (bound 10 s)"),
        ((36.0, 41.0), 0.6, "off in 81% of the last 5 s"),
        ((10.0, 19.0), 0.4, ""),  # it comes back
    ],
)
def test_an_end_effector_that_drifts_away_is_given_up(hover, tmp_path, saw, span, metres, says):
    outcome = outcome_of(edited(hover, tmp_path, topics.TRUE_ODOMETRY, off_from(*span, metres)))
    assert outcome.word == ("given up" if says else "completed")
    if says:
        assert says in outcome.reasons[0]
        saw(f"{metres:g} m off from {span[0]:g} s of 40 s on", f"given up: {outcome.reasons[0]}")


def test_a_vehicle_that_is_off_its_reference_is_given_up_though_the_arm_does_as_planned(
    tmp_path_factory, tmp_path
):
    folder = tmp_path_factory.mktemp("run") / "swing"
    settings = ("goal.joints.times_s=[5.0]", "goal.joints.positions_deg=[[10.0, 5.0, 130.0, 0.0]]")
    path, summary = simulated(folder, "arm_swing", *settings, duration_s=DURATION_S)
    assert summary["completed"], summary["reasons"]
    outcome = outcome_of(edited(path, tmp_path, topics.TRUE_ODOMETRY, off_from(0.0, 9.0, 2.0)))
    assert outcome.word == "given up"
    assert "the vehicle was within 0.5 m of its reference for 0% of the time" in outcome.reasons[0]


def test_a_filter_that_has_lost_its_way_excuses_nothing(run, tmp_path, saw):
    """Both the pose and its stated uncertainty go astray."""
    moved = edited(run, tmp_path / "a", topics.TRUE_ODOMETRY, off_from(0.0, 9.0, 3.0))
    unsure = edited(
        moved,
        tmp_path / "b",
        topics.ODOMETRY,
        lambda one: replace(one, pose_covariance=one.pose_covariance + 100.0 * np.eye(6)),
    )
    outcome = outcome_of(unsure)
    assert outcome.word == "given up"
    assert "its path for 0% of the time" in outcome.reasons[0]
    saw("3 m off under a filter that says 10 m of itself", f"given up: {outcome.reasons[0]}")


@pytest.mark.parametrize(
    ("wrong", "word"),
    [((0, 12.0, 0, 0), "completed"), ((0, 25.0, 0, 0), "given up")],
)
def test_joints_may_be_astray_at_the_end_within_their_looser_bound(
    uncontrolled, tmp_path, wrong, word
):
    def change(joints):
        late = joints.stamp > 4 * 10**9
        return replace(joints, position=joints.position + np.deg2rad(wrong) * late)

    outcome = outcome_of(edited(uncontrolled, tmp_path, topics.TRUE_JOINT_STATES, change))
    # Two of six seconds: less than half of the time, and of the last five less than half.
    assert outcome.completed
    longer = edited(
        uncontrolled,
        tmp_path / "longer",
        topics.TRUE_JOINT_STATES,
        lambda one: replace(
            one, position=one.position + np.deg2rad(wrong) * (one.stamp > 31 * 10**8)
        ),
    )
    assert outcome_of(longer).word == word
