"""The outcome of a run from its log alone: real runs, and real runs with one thing changed."""

from dataclasses import replace

import numpy as np
import pytest
from rewrite import rewrite

from uvms_analysis import limits
from uvms_analysis.check import check_log
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd
from uvms_analysis.outcome import EXIT_CODES, judge
from uvms_analysis.summary import summarise
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.messages import from_message, to_message
from uvms_core.signals import Allocation, AppliedThrust
from uvms_dynamics.kernels.rotations import rpy_to_quat

DURATION_S = 6.0
TICK = 50_000_000


def simulated(folder, scenario, *settings, **changes):
    ready = prepare(load_scenario(scenario, settings, **changes), str(folder), "lockstep", "uvms")
    return folder / "run.mcap", ready.run_simulation()


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Six seconds on a path."""
    folder = tmp_path_factory.mktemp("run") / "path"
    path, summary = simulated(folder, "manipulation", duration_s=DURATION_S)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    return path


@pytest.fixture(scope="module")
def uncontrolled(tmp_path_factory):
    """Six seconds in which the arm moves and nobody controls the vehicle."""
    folder = tmp_path_factory.mktemp("run") / "free"
    settings = ("control.enabled=false", "goal.joints.times_s=[5.0]")
    posture = "goal.joints.positions_deg=[[10.0, 5.0, 130.0, 0.0]]"
    path, summary = simulated(folder, "arm_swing", *settings, posture, duration_s=DURATION_S)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    return path


def edited(source, target, topic, change):
    """A copy of a log in which every signal of a topic goes through `change`."""
    vehicle = RunLog.open(source).vehicle
    thrusters = topic.signal in (Allocation, AppliedThrust)
    names = vehicle.thruster_names if thrusters else vehicle.joint_names
    own = codec(topic.type)

    def change_all(messages):
        for place, (name, entry) in enumerate(messages):
            if name == topic.resolve():
                signal = change(from_message(topic, own.decode(entry.data)))
                data = own.encode(to_message(topic, signal, names))
                messages[place] = (name, entry._replace(data=data))
        return messages

    return rewrite(source, target / "run.mcap", messages=change_all)


def ended(source, target, pace="lockstep", **changes):
    """A copy of a log with another record of the run's end."""
    end = replace(RunLog.open(source).end, **changes)

    def change(metadata):
        about = metadata["uvms"] | {"pace": pace}
        return metadata | {"uvms": about, "run_end": end.to_metadata()}

    return rewrite(source, target / "run.mcap", metadata=change)


def outcome_of(path):
    return judge(RunLog.open(path))


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


def capsized(after, degrees):
    def change(odometry):
        if odometry.stamp < after:
            return odometry
        return replace(odometry, quaternion=rpy_to_quat(np.deg2rad(degrees), 0.0, 0.0))

    return change


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


@pytest.mark.parametrize("why", ["SIGINT", "SIGTERM", "controller died (exit code -9)"])
def test_a_run_that_was_stopped_is_aborted(run, tmp_path, why):
    outcome = outcome_of(ended(run, tmp_path, stopped_by=why, asked_s=40.0))
    assert (outcome.word, outcome.reasons) == ("aborted", (f"stopped by {why}",))


def test_a_run_of_another_length_is_invalid(run, tmp_path, saw):
    longer = outcome_of(ended(run, tmp_path / "a", asked_s=15.0))
    assert (longer.word, longer.reasons) == (
        "invalid",
        ("it ends at 6.000 s of 15 s, and nothing says why",),
    )
    shorter = outcome_of(ended(run, tmp_path / "b", asked_s=2.0))
    assert shorter.reasons == ("it ends at 6.000 s, and 2 s were asked for",)
    saw("a span other than what was asked for", f"invalid: {longer.reasons[0]}", "2")


def test_lost_messages_and_others_in_the_run_are_invalid(run, tmp_path, saw):
    sent = RunLog.open(run).counts | {"/sensors/imu": 700}
    lost = outcome_of(ended(run, tmp_path / "a", sent=sent, lost={"/sensors/imu": 99}))
    assert lost.word == "invalid"
    assert lost.reasons == ("/sensors/imu: 99 of 700 messages that were sent are not in the log",)
    foreign = outcome_of(ended(run, tmp_path / "b", foreign=("/clock from /plant of run 7",)))
    assert foreign.reasons == (
        "the log: took part without belonging to the run: /clock from /plant of run 7",
    )
    saw("messages lost by the recorder", f"invalid: {lost.reasons[0]}")
    saw("a foreign publisher", f"invalid: {foreign.reasons[0]}")


def test_incidents_are_told_and_do_not_decide(run, tmp_path):
    path = ended(run, tmp_path, incidents=("controller was started again",))
    assert outcome_of(path).completed
    assert [str(f) for f in check_log(path).findings] == ["controller was started again"]


def without_commands(first, last):
    """The plant holds its safe state between two ticks."""

    def change(applied):
        if first <= applied.stamp // TICK < last:
            return replace(applied, thruster_safe=True)
        return applied

    return change


@pytest.mark.parametrize("pace", ["lockstep", "realtime:1"])
def test_a_plant_that_held_its_safe_state_makes_the_run_invalid(run, tmp_path, saw, pace):
    paced = ended(run, tmp_path / "paced", pace=pace)
    path = edited(paced, tmp_path / "safe", topics.APPLIED_THRUST, without_commands(40, 60))
    outcome = outcome_of(path)
    assert outcome.word == "invalid"
    assert outcome.reasons[0] == (
        "/thruster_command: the plant held its safe state in 20 of 120 ticks, first at 2.000 s: no"
        " command came in time"
    )
    saw(f"no thruster command for a second, {pace}", f"invalid: {outcome.reasons[0]}")


def late_by(ticks, count):
    """The plant uses old thruster commands in a number of ticks from 1 s on."""

    def change(applied):
        if 20 <= applied.stamp // TICK < 20 + count:
            old = applied.thruster_command_stamp - ticks * TICK
            return replace(applied, thruster_command_stamp=old)
        return applied

    return change


@pytest.mark.parametrize(
    ("pace", "ticks", "count", "valid"),
    [
        ("lockstep", 1, 1, False),
        ("realtime:1", 1, 6, True),  # by a period: within what the controller is laid out for
        ("realtime:1", 3, 4, True),
        ("realtime:1", 3, 10, False),
    ],
)
def test_late_and_unused_commands_make_the_run_invalid(
    run, tmp_path, saw, pace, ticks, count, valid
):
    paced = ended(run, tmp_path / "paced", pace=pace)
    path = edited(paced, tmp_path / "late", topics.APPLIED_THRUST, late_by(ticks, count))
    outcome = outcome_of(path)
    assert outcome.word == ("completed" if valid else "invalid")
    check = check_log(path)
    assert any("were never used" in str(finding) for finding in check.findings)
    assert check.oldest_command_ticks == ticks
    if not valid:
        saw(f"{count} of 120 commands {ticks} periods late, {pace}", outcome.reasons[0])


def test_the_worst_counts_and_every_reason_is_told(run, tmp_path):
    tilted = edited(run, tmp_path / "a", topics.TRUE_ODOMETRY, capsized(0, 90.0))
    path = ended(tilted, tmp_path / "b", stopped_by="SIGINT", foreign=("another plant",))
    outcome = outcome_of(path)
    assert outcome.word == "invalid"
    assert [reason.split(" ")[0] for reason in outcome.reasons] == ["the", "stopped", "roll", "the"]
    summary = summarise(path, wall_s=1.0)
    assert summary["completed"] is False
    assert summary["outcome"] == "invalid"
    assert summary["reasons"] == list(outcome.reasons)
    assert summary["check"]["verdict"] == "not complete"
    assert summary["end_effector_error_m"]["rms"] is not None
    assert EXIT_CODES[outcome.word] == 3


def test_what_a_run_ended_with_comes_back():
    end = RunEnd(3.0, "SIGINT", "running", {"/a": 3}, {"/a": 1}, ("x",), ("y",))
    assert RunEnd.from_metadata(end.to_metadata()) == end
