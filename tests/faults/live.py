"""Runs of `uvms` as processes of their own that a test can disturb."""

import json
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from graph import own_domain

from uvms_analysis.log.read import RunLog
from uvms_analysis.log.run_end import NAME, RunEnd

PATIENCE_S = 120.0


class LiveRun:
    """One command of `uvms` that is running; `folder` is its output."""

    def __init__(self, folder: Path, *arguments: str, **environment: str) -> None:
        self.folder = folder
        self.out = folder.parent / f"{folder.name}.out"
        with self.out.open("wb") as file:
            self.process = subprocess.Popen(
                [sys.executable, "-m", "uvms_bringup.cli", *arguments, "--output", str(folder)],
                stdout=file,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env=own_domain() | environment,
            )

    @property
    def text(self) -> str:
        """What it printed so far."""
        return self.out.read_text(errors="replace")

    @property
    def summary(self) -> dict[str, Any]:
        return json.loads((self.folder / "summary.json").read_text())

    @property
    def log(self) -> RunLog:
        return RunLog.open(self.folder / "run.mcap")

    @property
    def end(self) -> RunEnd:
        return RunEnd.from_metadata(self.log.metadata[NAME])

    def node(self, role: str) -> int:
        """Process id of the node of a role; 0 while there is none."""
        return children(self.process.pid).get(role, 0)

    def await_node(self, role: str) -> int:
        self.await_that(lambda: self.node(role) > 0)
        return self.node(role)

    def await_ticks(self, size: int = 150_000) -> None:
        """Until this much is in the log: the run is well under way."""
        log = self.folder / "run.mcap"
        self.await_that(lambda: log.exists() and log.stat().st_size > size)

    def await_that(self, ready: Callable[[], bool]) -> None:
        end = time.monotonic() + PATIENCE_S
        while not ready():
            assert self.process.poll() is None, self.text
            assert time.monotonic() < end, self.text
            time.sleep(0.05)

    def signal(self, number: int) -> None:
        self.process.send_signal(number)

    def code(self, timeout: float = PATIENCE_S) -> int:
        """The exit code, when it has ended."""
        return self.process.wait(timeout)


@contextmanager
def running(folder: Path, *arguments: str, **environment: str) -> Iterator[LiveRun]:
    """A run that is ended with the test."""
    run = LiveRun(folder, *arguments, **environment)
    try:
        yield run
    finally:
        if run.process.poll() is None:
            run.signal(signal.SIGCONT)
            run.signal(signal.SIGTERM)
            try:
                run.process.wait(30.0)
            except subprocess.TimeoutExpired:
                run.process.kill()
                run.process.wait()


def children(parent: int) -> dict[str, int]:
    """Processes of nodes that this process started, by role."""
    found = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                status = (entry / "stat").read_text().rpartition(")")[2].split()
                words = (entry / "cmdline").read_bytes().decode().split("\0")
            except OSError:
                continue
            if int(status[1]) == parent and "uvms_core.ros.main" in words and status[0] != "Z":
                found[words[words.index("uvms_core.ros.main") + 1]] = int(entry.name)
    return found


def is_alive(process: int) -> bool:
    """Whether a process runs; one that has ended and waits for its parent does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def gone(processes: list[int], seconds: float = 10.0) -> bool:
    """Whether all have ended within this time."""
    end = time.monotonic() + seconds
    while any(map(is_alive, processes)) and time.monotonic() < end:
        time.sleep(0.05)
    return not any(map(is_alive, processes))


def one_domain() -> dict[str, str]:
    """A domain for several runs of one test."""
    return {"ROS_DOMAIN_ID": own_domain()["ROS_DOMAIN_ID"]}


def no_domain() -> dict[str, str]:
    """None given: every run finds one by itself."""
    return {"ROS_DOMAIN_ID": ""}
