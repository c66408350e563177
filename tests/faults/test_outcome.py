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
from uvms_analysis.report import report
from uvms_analysis.report.page import write_page
from uvms_analysis.summary import summarise
from uvms_bringup.commands.summary_text import summary_text
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_control.controller import Controller
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.diagnostics import Status
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


def off_from(begin_s, end_s, metres):
    def change(odometry):
        if begin_s * 1e9 <= odometry.stamp < end_s * 1e9:
            return replace(odometry, position=odometry.position + np.array([0.0, metres, 0.0]))
        return odometry

    return change


@pytest.fixture(scope="module")
def hover(tmp_path_factory):
    """Forty seconds in which the vehicle holds its pose."""
    folder = tmp_path_factory.mktemp("run") / "hover"
    path, summary = simulated(folder, "hover", duration_s=40.0)
    assert (summary["outcome"], summary["reasons"]) == ("completed", [])
    assert all(counts["refused"] == 0 for counts in counters_of_parts(summary))
    return path


def counters_of_parts(summary):
    return [c for role, c in summary["node_counters"].items() if role != topics.PLANT]


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


def without(source, target, *gone, unsent=True):
    """A copy of a log without some topics; `unsent`: with a record that nobody sent them."""
    names = {topic.resolve() for topic in gone}
    end = RunLog.open(source).end
    end = replace(end, sent={k: v for k, v in end.sent.items() if k not in names or not unsent})
    return rewrite(
        source,
        target / "run.mcap",
        metadata=lambda all_: all_ | {"run_end": end.to_metadata()},
        messages=lambda all_: [(name, entry) for name, entry in all_ if name not in names],
    )


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


def with_statuses(source, target, *statuses):
    """A copy of a log in which nodes say more at the end."""
    own = codec(topics.DIAGNOSTICS.type)

    def change(messages):
        last = max(entry.stamp for name, entry in messages if name == "/clock")
        like = next(entry for name, entry in messages if name == "/diagnostics")
        for name, values in statuses:
            status = Status(last, name, values=values)
            data = own.encode(to_message(topics.DIAGNOSTICS, status, ()))
            messages.append(("/diagnostics", like._replace(stamp=last, data=data)))
        return messages

    end = RunLog.open(source).end
    sent = end.sent | {"/diagnostics": end.sent["/diagnostics"] + len(statuses)}
    return rewrite(
        source,
        target / "run.mcap",
        messages=change,
        metadata=lambda all_: all_ | {"run_end": replace(end, sent=sent).to_metadata()},
    )


@pytest.mark.parametrize(
    ("values", "word", "says"),
    [
        ({"unsafe_outputs": 1}, "given up", "controller made invalid in 1 ticks"),
        ({"resets": 1}, "invalid", "controller began anew 1 times, since time had jumped"),
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
    reason = "controller made invalid in 48 ticks; its safe output was used instead"
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
    summary = summarise(path, wall_s=1.0)
    assert summary["incidents"] == ["controller was started again"]
    assert summary["check"]["notes"] == ["controller was started again"]
    assert "incident: controller was started again" in summary_text(summary)
    page = write_page(tmp_path / "report.html", RunLog.open(path), summary, [])
    assert "Incident: controller was started again." in page.read_text(encoding="utf-8")


def test_a_foreign_message_too_brief_for_the_census_is_invalid(run, tmp_path, saw):
    end = RunLog.open(run).end
    fewer = end.sent | {"/reference": end.sent["/reference"] - 1}
    outcome = outcome_of(ended(run, tmp_path, sent=fewer, pace="realtime:1"))
    assert outcome.word == "invalid"
    assert "others took part" in outcome.reasons[0]
    saw("one message more in the log than was sent", f"invalid: {outcome.reasons[0]}")


@pytest.mark.parametrize(("said", "word"), [(None, "invalid"), (1.0, "completed")])
def test_the_plant_may_wait_at_the_start_as_long_as_it_says(run, tmp_path, said, word):
    paced = ended(run, tmp_path / "paced", pace="realtime:1")
    path = edited(paced, tmp_path / "safe", topics.APPLIED_THRUST, without_commands(0, 16))
    if said is not None:
        path = with_statuses(path, tmp_path / "said", ("plant", {"stale_s": said}))
    reasons = [one for one in outcome_of(path).reasons if "safe state" in one]
    assert bool(reasons) == (word == "invalid")


def test_what_is_not_known_is_null_with_a_reason(run, tmp_path):
    def forget(metadata):
        about = {k: v for k, v in metadata["uvms"].items() if k not in ("seed", "scenario")}
        return metadata | {"uvms": about}

    bare = without(run, tmp_path / "a", topics.TRUE_ODOMETRY)
    path = rewrite(bare, tmp_path / "b.mcap", metadata=forget)
    summary = summarise(path, wall_s=None)
    for name in ("seed", "scenario", "sim_duration_s", "real_time_factor"):
        assert summary[name] is None
        assert summary["missing"][name]
    assert "simulated: unknown, since" in summary_text(summary)


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
