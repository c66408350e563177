"""Whatever happens to the command line, it ends in one line and never in a traceback."""

import os
import random
import shutil
import signal
import subprocess
import sys
import time

import pytest
from graph import own_domain

PROGRAM = [sys.executable, "-m", "uvms_bringup.entry"]
UP = "up"
STUCK = """
import ctypes
from rclpy.node import Node
from uvms_core.ros import spin

class Stuck(Node):
    def destroy_node(self):
        ctypes.PyDLL(None).sleep(600)  # holds Python's global lock, as a deadlock in DDS does

spin.LEAVE_S = 1.0
spin.start(["stuck"])
spin.Spinner([Stuck("stuck")]).shutdown()
"""
SAYS_UP = f"""
from uvms_bringup.entry import main
print({UP!r}, flush=True)
raise SystemExit(main())
"""
"""`uvms`, which says when Python itself has started: before that nothing of ours can help."""
ASCII = {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}


def uvms(*arguments, cwd, environment=None, **options) -> subprocess.CompletedProcess:
    """Run the command line in a process of its own."""
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    values = os.environ | (environment or {})
    return subprocess.run([*PROGRAM, *arguments], cwd=cwd, env=values, text=True, **options)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Folder of a short run whose name is not ASCII."""
    folder = tmp_path_factory.mktemp("runs") / "größe 水"
    done = uvms("simulate", "hover", "--duration", "1", "--output", str(folder), cwd=folder.parent)
    assert done.returncode == 0, done.stderr
    return folder


@pytest.mark.parametrize("command", [["simulate", "hover"], ["run", "hover"], ["fields"]])
def test_a_working_directory_that_has_gone(tmp_path, saw, command):
    gone = tmp_path / "gone"
    gone.mkdir()
    script = f"rmdir {gone}; exec {sys.executable} -m uvms_bringup.entry {' '.join(command)}"
    done = subprocess.run(["sh", "-c", script], cwd=gone, capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr == (
        "error: the working directory does not exist any more; change to another one\n"
    )
    saw("working directory deleted", "one line, exit 2")


@pytest.mark.parametrize("environment", [ASCII, ASCII | {"PYTHONIOENCODING": "ascii"}])
def test_a_path_that_the_terminal_cannot_print(run, tmp_path, saw, environment):
    target = tmp_path / "größe"
    simulated = uvms(
        "simulate", "hover", "--duration", "0.5", "--output", str(target),
        cwd=tmp_path, environment=environment,
    )  # fmt: skip
    assert simulated.returncode == 0, simulated.stderr
    assert "Traceback" not in simulated.stderr
    assert "error" not in simulated.stderr
    assert (target / "run.mcap").is_file()
    refused = uvms("report", str(tmp_path / "größe.mcap"), cwd=tmp_path, environment=environment)
    assert refused.returncode == 2
    assert refused.stderr.startswith("error: ")
    saw("non-ASCII path, ASCII terminal", "runs; the path is printed with escapes")


def test_a_report_whose_path_the_terminal_cannot_print(run, tmp_path, saw):
    reported = uvms("report", str(run / "run.mcap"), cwd=tmp_path, environment=ASCII)
    assert (reported.returncode, reported.stderr) == (0, ""), reported.stderr
    saw("non-ASCII path of a report, ASCII terminal", "written; the path is printed with escapes")


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs Linux's /dev/full")
def test_output_that_cannot_be_written(tmp_path, saw):
    with open("/dev/full", "w") as full:
        done = uvms("fields", cwd=tmp_path, stdout=full)
    assert done.returncode not in (0, 70)
    assert "Traceback" not in done.stderr
    saw("standard output on a full disk", "one line, not exit 0")


def test_streams_that_are_closed(tmp_path, saw):
    program = " ".join(PROGRAM)
    script = f"{program} simulate hover --duration 0.5 --output out <&- >&- 2>&-"
    done = subprocess.run(["sh", "-c", script], cwd=tmp_path)
    assert done.returncode == 0
    assert (tmp_path / "out" / "summary.json").is_file()
    saw("standard streams closed", "the run is done and recorded all the same")


@pytest.mark.parametrize("command", ["simulate", "report"])
def test_a_disk_that_is_full_in_the_middle(run, tmp_path, saw, command):
    target = tmp_path / "copy"
    target.mkdir()
    shutil.copy(run / "run.mcap", target / "run.mcap")
    arguments = {
        "simulate": ["simulate", "hover", "--duration", "20", "--output", str(tmp_path / "out")],
        "report": ["report", str(target / "run.mcap")],
    }[command]
    # A limit on the size of files fails in the middle of a write, as a full disk does.
    script = f'ulimit -f 100; exec {" ".join(PROGRAM)} "$@"'
    done = subprocess.run(
        ["bash", "-c", script, "uvms", *arguments], cwd=tmp_path, capture_output=True, text=True
    )
    assert done.returncode not in (0, 70), done.stdout
    assert "Traceback" not in done.stderr
    assert done.stderr.count("error: ") == 1, done.stderr
    saw("disk full in the middle of a run or report", "one line, not exit 0")


def _default_signals():
    """A shell that starts the tests in the background has them ignore SIGINT."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def interrupt(arguments, after, cwd, number=signal.SIGINT):
    """Exit code and output of a command that gets a signal some seconds after Python's start."""
    process = subprocess.Popen(
        [sys.executable, "-c", SAYS_UP, *arguments],
        cwd=cwd,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
        preexec_fn=_default_signals,
    )
    assert process.stdout.readline().strip() == UP
    time.sleep(after)
    process.send_signal(number)
    out, _ = process.communicate(timeout=60)
    return process.returncode, out


RNG = random.Random(8)
INSTANTS = [RNG.uniform(0.0, 1.5) for _ in range(5)]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("after", [0.0, *INSTANTS])
def test_a_signal_at_any_instant(tmp_path, saw, after, number):
    arguments = ["simulate", "hover", "--duration", "100000", "--output", str(tmp_path / "out")]
    code, out = interrupt(arguments, after, tmp_path, number)
    assert "Traceback" not in out
    assert code in (128 + number, -number), out
    saw(f"{number.name} at any instant of `uvms simulate`", "no traceback, exit 130 or 143")


def test_a_process_that_cannot_leave_ros_is_ended(saw):
    done = subprocess.run(
        [sys.executable, "-c", STUCK], env=own_domain(), capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (1, "")
    saw("a deadlock of the middleware while a process leaves ROS", "the process ends after 10 s")
