"""Any node killed or halted at any instant: a clear end or full recovery, and a true log."""

import os
import random
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import numpy as np
import pytest
from live import LiveRun, children, gone, running

from uvms_analysis.outcome import EXIT_CODES
from uvms_core import topics

ROLES = tuple(topics.NODES)
PACES = {"lockstep": ("lockstep",), "realtime": ("realtime:2", "--respawn")}
SIGNALS = {"SIGKILL": signal.SIGKILL, "SIGSTOP": signal.SIGSTOP}
DURATION_S = 24
STALE_S = 0.5
"""The plant's `stale_s`: age at which it takes a command for missing."""
HALT_S = 3.0
RECOVERED_NS = 2_000_000_000
"""Simulated time at the end of a run in which everything must work again."""


def ages_of_used_commands(run: LiveRun) -> np.ndarray:
    """Age of each command when the plant used it, s: those that were not the safe state."""
    applied = run.log.signals(topics.APPLIED_THRUST)[1:]
    period = round(1e9 * 0.05)
    ages = []
    for each in applied:
        began = each.stamp - period
        ages += [began - each.thruster_command_stamp] * (not each.thruster_safe)
        ages += [began - each.joint_command_stamp] * (not each.joint_safe)
    return 1e-9 * np.array(ages)


def check_truth(run: LiveRun, pace: str) -> None:
    """Exit code, summary, record of the end and messages say the same."""
    outcome = run.summary["outcome"]
    assert run.process.returncode == EXIT_CODES[outcome], run.text
    assert "Traceback" not in run.text
    bound = 0.0 if pace == "lockstep" else STALE_S
    ages = ages_of_used_commands(run)
    assert len(ages)
    assert ages.max() <= bound + 1e-9
    assert ages.min() >= 0.0
    end = run.end
    reached = run.summary["sim_duration_s"]
    if outcome == "completed":
        assert reached == pytest.approx(end.asked_s)
        assert (end.stopped_by, dict(end.lost), end.foreign) == ("", {}, ())
    if reached < end.asked_s - 0.05:
        assert outcome in ("aborted", "invalid")


def check_recovered(run: LiveRun) -> None:
    """At the end every node works: the plant has used new commands for a while."""
    applied = run.log.signals(topics.APPLIED_THRUST)
    last = [each for each in applied if each.stamp > applied[-1].stamp - RECOVERED_NS]
    assert not any(each.thruster_safe or each.joint_safe for each in last)
    commands = {each.thruster_command_stamp for each in last}
    assert len(commands) > 0.5 * len(last)


def verdict(run: LiveRun) -> int:
    """Exit code of `uvms check`."""
    command = [sys.executable, "-m", "uvms_bringup.entry", "check", str(run.folder / "run.mcap")]
    return subprocess.run(command, capture_output=True, text=True).returncode


def disturb(run: LiveRun, role: str, number: int, pause_s: float) -> None:
    run.await_ticks(60_000)
    time.sleep(pause_s)
    process = run.node(role)
    if process and run.process.poll() is None:
        os.kill(process, number)
        if number == signal.SIGSTOP:
            time.sleep(HALT_S)
            os.kill(process, signal.SIGCONT)


def run_cell(folder, role, name, pace, pause_s) -> LiveRun:
    arguments = ("run", "hover", "--duration", str(DURATION_S), "--pace", *PACES[pace])
    with running(folder, *arguments) as run:
        disturb(run, role, SIGNALS[name], pause_s)
        run.code()
    check_truth(run, pace)
    if pace == "realtime" and name == "SIGKILL" and role != topics.PLANT:
        assert any(f"node {role} ended by signal 9" in text for text in run.end.incidents)
        check_recovered(run)
    elif name == "SIGKILL":
        assert run.end.stopped_by.startswith(f"node {role} ended by signal 9")
    else:
        assert run.summary["sim_duration_s"] == pytest.approx(DURATION_S)
        check_recovered(run)
    assert (verdict(run) == 0) == (run.summary["check"]["verdict"] == "complete")
    return run


@pytest.mark.parametrize(
    ("role", "name", "pace"),
    [
        (topics.THRUST_ALLOCATOR, "SIGKILL", "realtime"),
        pytest.param(topics.NAVIGATION, "SIGSTOP", "lockstep", marks=pytest.mark.long),
    ],
)
def test_some_cells(tmp_path, saw, role, name, pace):
    run = run_cell(tmp_path / "a", role, name, pace, 0.5)
    saw(f"{name} of {role}, {pace}", f"{run.summary['outcome']}; no command older than its bound")


@pytest.mark.long
@pytest.mark.parametrize("pace", PACES)
@pytest.mark.parametrize("name", SIGNALS)
@pytest.mark.parametrize("role", ROLES)
def test_the_kill_matrix(tmp_path, saw, role, name, pace):
    outcomes = []
    for instant in range(5):
        draw = random.Random(f"{role} {name} {pace} {instant}")
        run = run_cell(tmp_path / str(instant), role, name, pace, draw.uniform(0.0, 4.0))
        outcomes.append(run.summary["outcome"])
    counted = ", ".join(f"{outcomes.count(word)} {word}" for word in sorted(set(outcomes)))
    saw(f"{name} of {role}, {pace}", f"{counted}; no command older than its bound", "5")


@contextmanager
def under_way(folder, seed, pace):
    """A run at a random instant of its first seconds."""
    arguments = ("run", "hover", "--duration", str(DURATION_S), "--pace", *PACES[pace])
    with running(folder, *arguments) as run:
        run.await_ticks(60_000)
        time.sleep(random.Random(seed).uniform(0.0, 4.0))
        yield run


@pytest.mark.long
@pytest.mark.parametrize("pace", PACES)
def test_the_recorder_halted_at_any_instant(tmp_path, saw, pace):
    for instant in range(5):
        with under_way(tmp_path / str(instant), f"recorder {pace} {instant}", pace) as run:
            run.signal(signal.SIGSTOP)
            time.sleep(HALT_S)
            run.signal(signal.SIGCONT)
            run.code()
        check_truth(run, pace)
        if pace == "lockstep":
            assert run.end.lost == {}
    saw(f"SIGSTOP of the recorder, {pace}", "nothing lost, or counted and invalid", "5")


@pytest.mark.long
@pytest.mark.parametrize("pace", PACES)
def test_the_recorder_killed_at_any_instant(tmp_path, saw, pace):
    for instant in range(5):
        with under_way(tmp_path / str(instant), f"kill recorder {pace} {instant}", pace) as run:
            nodes = list(children(run.process.pid).values())
            run.signal(signal.SIGKILL)
            run.code()
        assert gone(nodes)
        assert run.log.fault  # the log opens, and says that its writer was killed
        assert verdict(run) == 1
        assert ages_of_used_commands(run).max() <= STALE_S + 1e-9
    saw(f"SIGKILL of the recorder, {pace}", "no orphan; the log opens and is not complete", "5")
