"""The nodes of a run as separate processes: command line, log file, clean shutdown."""

import os
import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from uvms_bringup.errors import RunError

PATIENCE_S = 10.0
"""Wall time that a node has to shut down by itself."""


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
    """Starts nodes as processes, detects when one dies, and stops them."""

    def __init__(self, log_folder: Path, environment: Mapping[str, str]) -> None:
        self._log_folder = log_folder
        self._environment = dict(environment)
        self._processes: dict[str, subprocess.Popen] = {}
        log_folder.mkdir(parents=True, exist_ok=True)

    def start(self, node: str, command: Sequence[str]) -> None:
        """Start a node; its output goes to a log file of its own."""
        with self.log_of(node).open("wb") as log:
            self._processes[node] = subprocess.Popen(
                command,
                stdout=log,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env=self._environment,
                start_new_session=True,  # Ctrl-C reaches only the parent, which stops the nodes
            )

    def log_of(self, node: str) -> Path:
        """Where a node's output goes."""
        return self._log_folder / f"{node}.log"

    def check(self) -> None:
        """Raise RunError if a node has died, with the end of its output."""
        for node, process in self._processes.items():
            if process.poll() is not None:
                tail = "\n".join(self.log_of(node).read_text(errors="replace").splitlines()[-8:])
                raise RunError(f"node {node} ended with code {process.returncode}:\n{tail}")

    def stop(self) -> None:
        """Stop all nodes: SIGINT first, then SIGKILL for any that ignores it."""
        for process in self._processes.values():
            if process.poll() is None:
                process.send_signal(signal.SIGINT)
        for process in self._processes.values():
            try:
                process.wait(PATIENCE_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def environment(log_folder: Path) -> dict[str, str]:
    """Environment of a run's processes: loopback only, and its own domain if none is set."""
    values = dict(os.environ)
    values.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    values.setdefault("ROS_DOMAIN_ID", str(1 + os.getpid() % 100))
    values["ROS_LOG_DIR"] = str(log_folder)
    return values
