"""The nodes of a run as separate processes: command line, log file, clean shutdown."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from uvms_bringup.errors import RunError
from uvms_core.ros.lifeline import GO, PARENT

PATIENCE_S = 10.0
"""Wall time that the nodes have to shut down by themselves."""
LEAST_LIFE_S = 5.0
"""Wall time that a node must have lived to be started again: one that dies at its start would
always do so."""


def node_command(
    role: str, parameter_file: Path, namespace: str = "", node: str | None = None
) -> list[str]:
    """The command that starts the node of a role.

    Args:
        role: name of the node in the graph.
        parameter_file: its parameters, in ROS's YAML form.
        namespace: "" is the root.
        node: name or `module:Class` of the node that fills the role; None: ours.
    """
    command = [sys.executable, "-m", "uvms_core.ros.main", node or role]
    command += ["--ros-args", "-r", f"__node:={role}", "--params-file", str(parameter_file)]
    return command + (["-r", f"__ns:=/{namespace}"] if namespace else [])


class NodeProcesses:
    """Starts nodes as processes, detects when one dies, and stops them.

    A node waits, with all its imports done, until `release` lets it into the graph.
    """

    def __init__(self, log_folder: Path, environment: Mapping[str, str]) -> None:
        self._log_folder = log_folder
        self._environment = dict(environment) | {PARENT: str(os.getpid())}
        self._processes: dict[str, subprocess.Popen] = {}
        self._commands: dict[str, Sequence[str]] = {}
        self._started: dict[str, float] = {}
        self._released = False
        log_folder.mkdir(parents=True, exist_ok=True)

    def start(self, node: str, command: Sequence[str]) -> None:
        """Start a node; its output goes to the end of a log file of its own."""
        with self.log_of(node).open("ab") as log:
            self._processes[node] = subprocess.Popen(
                command,
                stdout=log,
                stderr=subprocess.STDOUT,
                stdin=subprocess.PIPE,  # what it waits at, and whose end ends it
                env=self._environment,
                start_new_session=True,  # Ctrl-C reaches only the parent, which stops the nodes
            )
        self._commands[node], self._started[node] = command, time.monotonic()

    def release(self) -> None:
        """Let all nodes into the graph."""
        self._released = True
        for process in self._processes.values():
            _let_in(process)

    def log_of(self, node: str) -> Path:
        """Where a node's output goes."""
        return self._log_folder / f"{node}.log"

    def dead(self) -> list[str]:
        """Nodes that have ended."""
        return [node for node, process in self._processes.items() if process.poll() is not None]

    def check(self) -> None:
        """Raise RunError if a node has died, with the end of its output."""
        for node in self.dead():
            raise RunError(self.exit_report(node))

    def exit_report(self, node: str) -> str:
        """How a node ended, with the end of its output."""
        code = self._processes[node].returncode
        tail = "\n".join(self.log_of(node).read_text(errors="replace").splitlines()[-8:])
        return f"node {node} ended {_how(code)}" + (f":\n{tail}" if tail else "")

    def start_again(self, node: str) -> None:
        """Start a node that has ended.

        Raises:
            RunError: it died soon after its start.
        """
        if time.monotonic() - self._started[node] < LEAST_LIFE_S:
            raise RunError(f"{self.exit_report(node)}\nIt died soon after its start")
        _close_input(self._processes[node])
        self.start(node, self._commands[node])
        _let_in(self._processes[node])

    def stop(self) -> None:
        """Stop all nodes: SIGINT first, then SIGKILL for any that ignores it."""
        for process in self._processes.values():
            if not self._released:
                _close_input(process)  # ends a node that still waits there
            elif process.poll() is None:
                process.send_signal(signal.SIGINT)
                process.send_signal(signal.SIGCONT)  # one that was halted could not take it
        deadline = time.monotonic() + PATIENCE_S
        for process in self._processes.values():
            try:
                process.wait(max(deadline - time.monotonic(), 0.0))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            _close_input(process)


def _how(code: int) -> str:
    return f"by signal {-code} ({signal.strsignal(-code)})" if code < 0 else f"with code {code}"


def _let_in(process: subprocess.Popen) -> None:
    if process.stdin is not None:
        try:
            process.stdin.write(GO)
            process.stdin.flush()
        except BrokenPipeError:  # it is dead, which `check` reports
            pass


def _close_input(process: subprocess.Popen) -> None:
    if process.stdin is not None:
        try:
            process.stdin.close()
        except BrokenPipeError:
            pass


def environment(log_folder: Path) -> dict[str, str]:
    """Environment of a run's processes: loopback only, ROS's own logs in a folder."""
    values = dict(os.environ)
    values.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    values["ROS_LOG_DIR"] = str(log_folder)
    return values
