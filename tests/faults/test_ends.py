"""Every end of a run: exit code, log and the record of the end agree."""

import json
import os
import random
import signal
import subprocess
import sys
import time

import pytest
from live import LiveRun, running

from uvms_bringup.claim import Claim, Holder, TakenError

RUNS = {
    "simulate": ("simulate", "hover", "--duration", "6000"),
    "composed": ("run", "hover", "--composed", "--duration", "6000"),
    "separate": ("run", "hover", "--duration", "6000"),
}
CODES = {signal.SIGINT: 130, signal.SIGTERM: 143}


def check_stopped(run: LiveRun, number: int) -> None:
    assert run.code(40.0) == CODES[number], run.text
    assert "Traceback" not in run.text
    assert run.log.fault == ""
    assert run.end.stopped_by == signal.Signals(number).name
    assert run.summary["outcome"] == "aborted"
    assert run.summary["completed"] is False


@pytest.mark.parametrize(
    ("kind", "number"),
    [
        ("simulate", signal.SIGINT),
        ("simulate", signal.SIGTERM),
        pytest.param("composed", signal.SIGINT, marks=pytest.mark.long),
        ("separate", signal.SIGTERM),
    ],
)
def test_a_signal_during_a_run(tmp_path, saw, kind, number):
    with running(tmp_path / "a", *RUNS[kind]) as run:
        run.await_ticks()
        run.signal(number)
        check_stopped(run, number)
    name = signal.Signals(number).name
    saw(f"{name} during a run ({kind})", f"exit {CODES[number]}, log closed, aborted")


@pytest.mark.parametrize("delay_s", [pytest.param(0.3, marks=pytest.mark.long), 2.0])
def test_a_signal_while_a_run_starts(tmp_path, saw, delay_s):
    with running(tmp_path / "a", *RUNS["separate"]) as run:
        time.sleep(delay_s)
        run.signal(signal.SIGTERM)
        assert run.code(40.0) in (143, -signal.SIGTERM), run.text
    assert "Traceback" not in run.text
    saw("SIGTERM while a run starts", "exit 143, nodes stopped, no traceback")


@pytest.mark.long
@pytest.mark.parametrize("seed", range(10))
def test_a_signal_at_any_instant(tmp_path, saw, seed):
    draw = random.Random(seed)
    number = draw.choice(list(CODES))
    with running(tmp_path / "a", *RUNS["separate"]) as run:
        time.sleep(draw.uniform(0.5, 8.0))
        run.signal(number)
        assert run.code(40.0) in (CODES[number], -number), run.text
    assert "Traceback" not in run.text
    saw("a signal at a random instant of a run", "exit 130 or 143, no traceback", "10")


def test_a_node_that_dies_ends_the_run_in_lockstep(tmp_path, saw):
    with running(tmp_path / "a", *RUNS["separate"]) as run:
        run.await_ticks()
        os.kill(run.node("controller"), signal.SIGKILL)
        assert run.code(60.0) == 1, run.text
    assert run.end.stopped_by.startswith("node controller ended by signal 9")
    assert run.summary["outcome"] == "aborted"
    saw("a node is killed in lockstep", "the run ends at once, aborted, exit 1, names the node")


def test_a_full_disk_is_one_line(tmp_path, saw):
    limited = (
        "import resource, signal, sys; signal.signal(signal.SIGXFSZ, signal.SIG_IGN);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (300_000, 300_000));"
        "from uvms_bringup.cli import main; sys.exit(main(sys.argv[1:]))"
    )
    done = subprocess.run(
        [sys.executable, "-c", limited, "simulate", "hover", "--output", str(tmp_path / "a")],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert [line for line in done.stderr.splitlines() if "error: " in line and "run.mcap" in line]
    saw("the disk is full", "one line that names the log, exit 2")


def test_an_output_that_is_a_file_is_one_line(tmp_path):
    (tmp_path / "a").write_text("")
    done = subprocess.run(
        [sys.executable, "-m", "uvms_bringup.cli", "simulate", "hover", "--output", "a/b"],
        capture_output=True, text=True, check=False, cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 2
    assert done.stderr.strip().startswith("error: --output ")
    assert len(done.stderr.strip().splitlines()) == 1


def test_json_is_all_that_goes_to_standard_output(tmp_path):
    arguments = ["simulate", "hover", "--duration", "0.5", "--json", "--output", "a"]
    done = subprocess.run(
        [sys.executable, "-m", "uvms_bringup.cli", *arguments],
        capture_output=True, text=True, check=True, cwd=tmp_path,
    )  # fmt: skip
    assert json.loads(done.stdout) == json.loads((tmp_path / "a/summary.json").read_text())


def test_a_claim_is_one_process_s_and_goes_with_it(tmp_path):
    mine, yours = Holder("a1", 1, "uvms run"), Holder("b2", 2, "uvms simulate")
    claim = Claim(tmp_path / "lock", mine)
    with pytest.raises(TakenError, match=r"run a1 \(process 1: uvms run\)"):
        Claim(tmp_path / "lock", yours)
    claim.release()
    (tmp_path / "lock").write_text('{"run_id": "c3", "process": 3, "command": "killed"}')
    again = Claim(tmp_path / "lock", yours)
    assert again.left_by == Holder("c3", 3, "killed")
    again.release()
    assert not (tmp_path / "lock").exists()
