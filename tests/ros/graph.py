"""Runs of the real graph for the tests: own process, own ROS domain, loopback only."""

import itertools
import json
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from uvms_analysis.log.read import RunLog
from uvms_core.topics import Topic

_DOMAINS = itertools.count(10 + os.getpid() % 40)


@dataclass(frozen=True)
class Outcome:
    """What a command of `uvms` left behind."""

    code: int
    out: str
    err: str
    folder: Path

    @property
    def summary(self) -> dict[str, Any]:
        return json.loads((self.folder / "summary.json").read_text())

    @property
    def log(self) -> RunLog:
        return RunLog.open(self.folder / "run.mcap")


def own_domain() -> dict[str, str]:
    """Environment with a ROS domain that no other run of this session uses."""
    return dict(
        os.environ,
        ROS_DOMAIN_ID=str(next(_DOMAINS) % 100 + 1),
        ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST",
    )


def uvms(folder: Path, *arguments: str, timeout: float = 300.0) -> Outcome:
    """Run `uvms ... --output folder` to its end."""
    command = [sys.executable, "-m", "uvms_bringup.cli", *arguments, "--output", str(folder)]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=timeout, env=own_domain(), check=False
    )
    return Outcome(done.returncode, done.stdout, done.stderr, folder)


def finished(outcome: Outcome) -> Outcome:
    """The outcome, or a failure with what the command printed."""
    if outcome.code != 0:
        pytest.fail(f"code {outcome.code}\n{outcome.out}\n{outcome.err}")
    return outcome


def column(log: RunLog, topic: Topic, name: str) -> np.ndarray:
    """One field of a topic over the run."""
    return getattr(log.series(topic), name)
