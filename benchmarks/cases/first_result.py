"""From the start of a process to its first forward dynamics: kernels cached, or compiled."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from metrics import Metric, Target

PROGRAM = Path(__file__).resolve().parents[1] / "first_result.py"
WARM_RUNS, PATIENCE_S = 7, 300.0


def measure(full: bool) -> Iterator[Metric]:
    """Wall time, since that is what a user waits for; median of several runs with cached kernels.

    The parts' ratio is their share of the whole. Python's own bytecode is cached in both.
    """
    _run({})  # fills the cache for the others
    warm = [_run({}) for _ in range(WARM_RUNS)]
    parts = {name: statistics.median(run[name] for run in warm) for name in warm[0]}
    yield from _metrics("first_result_warm", parts, 1.5)
    with tempfile.TemporaryDirectory() as folder:
        parts = _run({"NUMBA_CACHE_DIR": folder})
    yield from _metrics("first_result_cold", parts, 30.0)


def _metrics(name: str, parts: dict[str, float], bound: float) -> Iterator[Metric]:
    whole = parts.pop("whole")
    yield Metric(name, whole, "s", target=Target("value", "<=", bound))
    for part, seconds in parts.items():
        yield Metric(f"{name}_{part}", seconds, "s", "the whole", seconds / whole)


def _run(variables: dict[str, str]) -> dict[str, float]:
    """Seconds of the whole and of each part of a run in a process of its own."""
    began = time.monotonic()
    done = subprocess.run(
        [sys.executable, str(PROGRAM)],
        capture_output=True, text=True, env={**os.environ, **variables}, timeout=PATIENCE_S,
        check=False,
    )  # fmt: skip
    if done.returncode != 0:
        raise RuntimeError(
            f"first_result.py ended with code {done.returncode}: {done.stderr[-300:]}"
        )
    printed = json.loads(done.stdout)
    if not printed["finite"]:
        raise ArithmeticError("the first result is not finite")
    parts, before = {}, began
    for name, reading in printed["readings"].items():
        parts[name], before = reading - before, reading
    return {"whole": before - began, **parts}
