"""A run whose log does not prove what happened does not count as completed."""

from dataclasses import replace

import numpy as np
import pytest
from outcome_runs import (
    DURATION_S,
    TICK,
    capsized,
    edited,
    ended,
    outcome_of,
    simulated,
    with_statuses,
    without,
)

from uvms_analysis import limits
from uvms_analysis.log.read import RunLog
from uvms_analysis.report import report
from uvms_analysis.summary import summarise
from uvms_control.controller import Controller
from uvms_core import topics


@pytest.mark.parametrize(
    ("topic", "unsent"),
    [
        (topics.TRUE_ODOMETRY, True),
        (topics.TRUE_ODOMETRY, False),
        (topics.TRUE_JOINT_STATES, True),
        (topics.APPLIED_THRUST, True),
        (topics.ALLOCATION, True),
        (topics.REFERENCE, True),
        (topics.ODOMETRY, True),
    ],
)
def test_a_run_without_what_it_is_judged_by_is_invalid(run, tmp_path, saw, topic, unsent):
    outcome = outcome_of(without(run, tmp_path, topic, unsent=unsent))
    assert outcome.word == "invalid"
    assert any(topic.resolve() in reason for reason in outcome.reasons)
    if unsent:
        saw(f"no {topic.name} in the log", f"invalid: {outcome.reasons[0]}")


OF_A_SIMULATION = (topics.TRUE_ODOMETRY, topics.TRUE_JOINT_STATES, topics.APPLIED_THRUST)


def by_a_foreign_plant(source, target):
    """As of a plant that gives no counts, and has no truth to publish."""
    bare = without(source, target / "bare", *OF_A_SIMULATION)
    end = RunLog.open(bare).end
    of_plant = {topic.resolve() for topic in topics.NODES[topics.PLANT].outputs} | {"/clock"}
    return ended(
        bare, target / "end", sent={k: v for k, v in end.sent.items() if k not in of_plant}
    )


def test_a_foreign_plant_without_truth_is_judged_by_the_estimates(run, tmp_path, saw):
    path = by_a_foreign_plant(run, tmp_path)
    summary = summarise(path, wall_s=None)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    assert summary["judged_by"] == "estimates"
    notes = summary["check"]["notes"]
    assert {note.split(":")[0] for note in notes} == {one.resolve() for one in OF_A_SIMULATION}
    capsize = edited(path, tmp_path / "c", topics.ODOMETRY, capsized(3 * 10**9, 148.0))
    assert outcome_of(capsize).reasons[0].startswith("roll or pitch beyond 30 deg from 3.00 s on")
    saw("a foreign plant that publishes no truth", "judged by the estimates, which a note says")


def test_without_estimates_either_nothing_can_be_judged(run, tmp_path):
    path = without(by_a_foreign_plant(run, tmp_path), tmp_path / "blind", topics.ODOMETRY)
    outcome = outcome_of(path)
    assert outcome.word == "invalid"
    assert any("its limits cannot be judged (attitude)" in reason for reason in outcome.reasons)


def test_truths_without_a_common_stamp_are_a_reason_and_no_error(run, tmp_path, saw):
    path = edited(
        run,
        tmp_path,
        topics.TRUE_JOINT_STATES,
        lambda one: replace(one, stamp=one.stamp + 1_000_000),
    )
    outcome = outcome_of(path)
    assert outcome.word == "invalid"
    lack = "ground_truth/odometry and ground_truth/joint_states have no stamp in common"
    assert any(lack in reason for reason in outcome.reasons)
    page = report(path, tmp_path / "report").read_text(encoding="utf-8")
    assert f"No figure: {lack}" in page
    saw("odometry and joints of the truth share no stamps", f"invalid: {outcome.reasons[0]}")


@pytest.mark.parametrize(
    ("values", "word", "says"),
    [
        ({"unsafe_outputs": 1}, "given up", "controller: its output was invalid in 1 ticks"),
        ({"resets": 1}, "invalid", "controller restarted 1 times, since time had jumped"),
        ({"refused": 6}, "completed", ""),  # of 121 ticks: 5 %
        ({"refused": 7}, "invalid", "controller refused 7 inputs in 121 ticks (bound 5%)"),
        ({"held": 7}, "invalid", "controller replaced 7 inputs in 121 ticks (bound 5%)"),
    ],
)
def test_what_nodes_count_reaches_the_outcome(run, tmp_path, saw, values, word, says):
    outcome = outcome_of(with_statuses(run, tmp_path, ("rov/controller", values)))
    assert outcome.word == word
    if says:
        assert outcome.reasons[0].startswith(says)
        saw(f"a node counts {next(iter(values))}", f"{word}: {outcome.reasons[0]}")


def test_the_counts_of_all_starts_of_a_node_add_up(run, tmp_path):
    said = [("controller", {"refused": n}) for n in (2, 3, 0, 1)]
    counts = summarise(with_statuses(run, tmp_path, *said), wall_s=1.0)["node_counters"]
    assert counts["controller"]["refused"] == 3 + 1


def test_a_run_whose_nodes_say_nothing_is_invalid(run, tmp_path):
    outcome = outcome_of(without(run, tmp_path, topics.DIAGNOSTICS))
    assert outcome.word == "invalid"
    assert outcome.reasons == ("no node says on /diagnostics what it has counted",)


class Often(Controller):
    """A user's law that makes no number in two of five ticks."""

    def step(self, odometry, joints, disturbance, reference):
        wrench, command = super().step(odometry, joints, disturbance, reference)
        bad = odometry.stamp // TICK % 5 in (1, 3)
        return (replace(wrench, wrench=wrench.wrench * np.nan) if bad else wrench), command


def test_a_law_that_makes_rubbish_in_process_is_given_up(tmp_path, saw):
    setting = f"control.law={__name__}:Often"
    _, summary = simulated(tmp_path / "run", "hover", setting, duration_s=DURATION_S)
    assert summary["outcome"] == "given up"
    reason = "controller: its output was invalid in 48 ticks, and replaced by a safe one"
    assert summary["reasons"][0] == reason
    assert summary["node_counters"]["controller"]["unsafe_outputs"] == 48
    saw("a law that returns NaN in 40 % of the ticks", f"given up: {reason}")


@pytest.mark.parametrize(("share", "given_up"), [(0.3, False), (0.7, True)])
def test_thrusters_at_their_limits_for_long_are_given_up(run, tmp_path, saw, share, given_up):
    def change(allocation):
        saturated = np.zeros(len(allocation.thrust), dtype=bool)
        saturated[2] = (allocation.stamp // TICK) % 10 < 10 * share
        return replace(allocation, saturated=saturated)

    outcome = outcome_of(edited(run, tmp_path, topics.ALLOCATION, change))
    assert outcome.word == ("given up" if given_up else "completed")
    if given_up:
        assert "thrusters at their limits in 70% of the ticks" in outcome.reasons[0]
        saw("thrusters saturated for long", f"given up: {outcome.reasons[0]}")


def test_a_stretch_at_the_limits_without_a_break_is_measured():
    flags = np.array([False, True, True, True, False, True, True, False])
    assert limits._longest(flags, 0.5 * np.arange(8.0)) == 1.0


@pytest.mark.parametrize("goal", ["aborted", "canceled", "rejected"])
def test_a_goal_that_did_not_succeed_is_given_up(run, tmp_path, goal):
    outcome = outcome_of(ended(run, tmp_path, goal=goal))
    assert outcome.word == "given up"
    assert outcome.reasons == (f"the planner's goal was {goal}",)


def test_a_goal_that_outlasts_the_span_that_was_asked_for_is_no_fault(run, tmp_path):
    assert outcome_of(ended(run, tmp_path, goal="running")).completed


def test_a_goal_that_should_have_ended_is_given_up(uncontrolled, tmp_path):
    outcome = outcome_of(ended(uncontrolled, tmp_path, goal="running"))
    assert outcome.reasons == ("the planner's goal was still running at the end",)
