"""The ROS graph in lockstep, composed and in separate processes, against the loop without ROS."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

from metrics import Metric, Target

PROGRAM = Path(__file__).resolve().parents[1] / "graph.py"
PATIENCE_S = 600.0
BOUNDS = {"composed": 15.0, "separate": 6.0}
ROUNDS = 2


def measure(full: bool) -> Iterator[Metric]:
    """30 s of the manipulation (900 s, once, if `full`), recorded to a log each time.

    Factors are of the running phase, without the time that processes take to start and to load
    compiled kernels, which `..._start_up` gives. The kinds take turns; values are of the best
    round, because other programs share the machine, ratios the median of the rounds'.
    """
    seconds = 900.0 if full else 30.0
    rounds = [
        {how: _run(how, seconds) for how in ("simulate", *BOUNDS)}
        for _ in range(1 if full else ROUNDS)
    ]
    factors = {how: [one[how]["running_factor"] for one in rounds] for how in rounds[0]}
    best = max(factors["simulate"])
    yield Metric("simulate_logged", best, "x real time", "real time", best)
    for how, bound in BOUNDS.items():
        pairs = zip(factors[how], factors["simulate"], strict=True)
        yield Metric(
            f"lockstep_{how}", max(factors[how]), "x real time", "uvms simulate",
            statistics.median(a / b for a, b in pairs), Target("value", ">=", bound),
        )  # fmt: skip
        yield Metric(f"lockstep_{how}_start_up", min(one[how]["start_up_s"] for one in rounds), "s")
        yield Metric(
            f"lockstep_{how}_timeouts", sum(one[how]["lockstep_timeouts"] for one in rounds), "1",
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
        errors = [line for line in done.stderr.splitlines() if line.strip()]
        raise RuntimeError(f"{how} ended with code {done.returncode}: {' | '.join(errors[-3:])}")
    return json.loads(done.stdout.splitlines()[-1])
