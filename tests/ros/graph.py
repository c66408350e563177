"""Runs of the real graph for the tests: own process, own ROS domain, loopback only."""

import contextlib
import fcntl
import itertools
import json
import os
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rclpy

from uvms_analysis.log.read import RunLog
from uvms_bringup.cli import main
from uvms_core.topics import Topic

ENOUGH = 20
"""Domains of one session of tests: several share a machine, and each goes round its own."""


def _domains() -> Iterator[int]:
    """Some of the domains 1 to 100 that no other session of tests has, round and round."""
    mine: list[tuple[int, Any]] = []  # the open files hold the locks to the end of the session
    for k in range(100):
        if len(mine) == ENOUGH:
            break
        domain = (os.getpid() + k) % 100 + 1
        try:
            lock = open(Path(tempfile.gettempdir()) / f"uvms_tests_domain_{domain}", "w")
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:  # another session, or another user, has it
            continue
        mine.append((domain, lock))
        yield domain
    if not mine:
        raise RuntimeError("other sessions of tests hold all ROS domains from 1 to 100")
    yield from itertools.cycle([domain for domain, _ in mine])


_DOMAINS = _domains()


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
        ROS_DOMAIN_ID=str(next(_DOMAINS)),
        ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST",
    )


def uvms(folder: Path, *arguments: str, timeout: float = 300.0) -> Outcome:
    """Run `uvms ... --output folder` to its end."""
    command = [sys.executable, "-m", "uvms_bringup.cli", *arguments, "--output", str(folder)]
    done = subprocess.run(
        command, capture_output=True, text=True, timeout=timeout, env=own_domain(), check=False
    )
    return Outcome(done.returncode, done.stdout, done.stderr, folder)


def uvms_here(folder: Path, *arguments: str) -> Outcome:
    """The same in this process: with all imports and kernels at hand, where no test needs its own.

    The nodes of a `run` must be in this process, too.
    """
    assert arguments[0] != "run" or "--composed" in arguments, arguments
    variables = dict(os.environ)
    blocked = signal.pthread_sigmask(signal.SIG_BLOCK, ())
    try:
        os.environ.update(own_domain())
        with (
            tempfile.TemporaryFile("w+", encoding="utf-8") as out,  # ROS wants a file's number
            tempfile.TemporaryFile("w+", encoding="utf-8") as err,
            contextlib.redirect_stdout(out),
            contextlib.redirect_stderr(err),
        ):
            code = main([*arguments, "--output", str(folder)])
            texts = [file.seek(0) or file.read() for file in (out, err)]
    finally:  # what a run changes for the whole of its process
        rclpy.try_shutdown()
        signal.pthread_sigmask(signal.SIG_SETMASK, blocked)
        os.environ.clear()
        os.environ.update(variables)
    return Outcome(code, *texts, folder)


def finished(outcome: Outcome) -> Outcome:
    """The outcome, or a failure with what the command printed."""
    if outcome.code != 0:
        pytest.fail(f"code {outcome.code}\n{outcome.out}\n{outcome.err}")
    return outcome


def column(log: RunLog, topic: Topic, name: str) -> np.ndarray:
    """One field of a topic over the run."""
    return getattr(log.series(topic), name)
