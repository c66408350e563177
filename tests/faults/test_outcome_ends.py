"""How a run ended, what it lost and which commands were used, in its outcome."""

from dataclasses import replace

import pytest
from outcome_runs import (
    TICK,
    capsized,
    edited,
    ended,
    outcome_of,
    with_statuses,
    without,
)
from rewrite import rewrite

from uvms_analysis.check import check_log
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import RunEnd
from uvms_analysis.outcome import EXIT_CODES
from uvms_analysis.report.page import write_page
from uvms_analysis.summary import summarise
from uvms_bringup.commands.summary_text import summary_text
from uvms_core import topics


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
    page = write_page(tmp_path / "report.html", RunLog.open(path), summary)
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
