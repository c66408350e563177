"""The ROS graph in lockstep, composed and in separate processes, against the loop without ROS."""

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from figures import Figure, Target

PROGRAM = Path(__file__).resolve().parents[1] / "graph.py"
PATIENCE_S = 300.0
BOUNDS = {"composed": 15.0, "separate": 6.0}


def measure(full: bool) -> Iterator[Figure]:
    """30 s of the manipulation (900 s if `full`), recorded to a log each time.

    Factors are of the running phase: without the time that processes take to start and to load
    what numba compiled. `..._to_the_end` is with it, from the summary.
    """
    seconds = 900.0 if full else 30.0
    without_ros = _run("simulate", seconds)["running_factor"]
    yield Figure("simulate_logged", without_ros, "x real time", "real time", without_ros)
    for how, bound in BOUNDS.items():
        summary = _run(how, seconds)
        factor = summary["running_factor"]
        yield Figure(
            f"lockstep_{how}", factor, "x real time", "uvms simulate", factor / without_ros,
            Target("value", ">=", bound),
        )  # fmt: skip
        whole = summary["real_time_factor"]
        yield Figure(
            f"lockstep_{how}_to_the_end", whole, f"x real time over {seconds:g} s, start included",
            "the running phase", whole / factor,
        )  # fmt: skip
        yield Figure(
            f"lockstep_{how}_timeouts", summary["lockstep_timeouts"], "1",
            target=Target("value", "<=", 0.0),
        )  # fmt: skip


def _run(how: str, seconds: float) -> dict:
    """The summary of a run in a process and a ROS domain of its own."""
    environment = dict(
        os.environ,
        ROS_DOMAIN_ID=str(1 + os.getpid() % 100),
        ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST",
    )
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(
            [sys.executable, str(PROGRAM), how, str(seconds), folder],
            capture_output=True, text=True, env=environment, timeout=PATIENCE_S, check=False,
        )  # fmt: skip
    if done.returncode != 0:
        raise RuntimeError(f"{how}: code {done.returncode}: {done.stderr[-500:]}")
    return json.loads(done.stdout.splitlines()[-1])
