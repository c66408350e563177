"""A graph as somebody starts it by hand: one process a node, real DDS, pace realtime."""

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
from graph import own_domain
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.errors import UvmsError
from uvms_core.messages import from_message
from uvms_core.ros.convert import message_class
from uvms_core.ros.spin import Spinner
from uvms_core.ros.subscribe import qos_profile


class Ear(Node):
    """Hears all outputs of the loop as bytes, and can publish any."""

    def __init__(self) -> None:
        super().__init__("ear")
        self.heard: dict[str, list[tuple[float, Any]]] = {}
        self.invalid: list[str] = []
        self.last: dict[str, bytes] = {}
        self.trusting = True
        self._mouths: dict[str, Any] = {}
        for topic in topics.ALL:
            if topic.signal is not None and topic is not topics.TF:
                self._hear(topic)

    def say(self, topic: Any, data: bytes) -> None:
        if topic.name not in self._mouths:
            self._mouths[topic.name] = self.create_publisher(
                message_class(topic), topic.name, qos_profile(topic.qos)
            )
        self._mouths[topic.name].publish(data)

    def _hear(self, topic: Any) -> None:
        def take(data: bytes) -> None:
            try:
                heard = from_message(topic, codec(topic.type).decode(data))
            except UvmsError as fault:
                self.invalid.append(str(fault))
                return
            self.last[topic.name] = data
            self.heard.setdefault(topic.name, []).append((time.monotonic(), heard))

        self.create_subscription(
            message_class(topic), topic.name, take, qos_profile(topic.qos), raw=True
        )

    def since(self, topic: Any, wall: float) -> list[Any]:
        return [signal for when, signal in self.heard.get(topic.name, []) if when >= wall]


class HandStarted:
    """The processes by role, and an ear in this one."""

    def __init__(self, folder: Path, **values: str) -> None:
        self.environment = own_domain()
        self._folder, self._values = folder, values
        self.processes: dict[str, subprocess.Popen[bytes]] = {}
        rclpy.init(
            domain_id=int(self.environment["ROS_DOMAIN_ID"]),
            signal_handler_options=SignalHandlerOptions.NO,
        )
        self.ear = Ear()
        self.spinner = Spinner([self.ear])

    def start(self, role: str, **values: str) -> float:
        """Start a node; returns the wall time."""
        given = {"pace": "realtime", "run_id": "hand"} | self._values | values
        command = [sys.executable, "-m", "uvms_core.ros.main", role, "--ros-args"]
        for name, value in given.items():
            command += ["-p", f"{name}:={value}"]
        with (self._folder / f"{role}.log").open("ab") as log:
            self.processes[role] = subprocess.Popen(
                command, env=self.environment, stdout=log, stderr=log
            )
        return time.monotonic()

    def kill(self, role: str) -> None:
        process = self.processes.pop(role)
        process.send_signal(signal.SIGKILL)
        process.wait()

    def listen(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.spinner.spin_once(0.05)

    def until(self, ready: Any, patience: float) -> float:
        """Listen until ready; returns how long it took, s."""
        began = time.monotonic()
        while not ready():
            if time.monotonic() - began > patience:
                logs = {r: self.log(r)[-600:] for r in self.processes}
                raise AssertionError(f"not within {patience} s; {logs}")
            self.spinner.spin_once(0.05)
        return time.monotonic() - began

    def log(self, role: str) -> str:
        return (self._folder / f"{role}.log").read_text(errors="replace")

    def alive(self) -> bool:
        return all(process.poll() is None for process in self.processes.values())

    def moves(self, wall: float) -> bool:
        """Whether the plant has used the loop's commands since a wall time."""
        applied = self.ear.since(topics.APPLIED_THRUST, wall)
        return len(applied) > 10 and not any(a.thruster_safe or a.joint_safe for a in applied[-10:])

    def close(self) -> None:
        for process in self.processes.values():
            process.kill()
            process.wait()
        self.spinner.shutdown()
        rclpy.try_shutdown()


@contextmanager
def hand_started(folder: Path, **values: str):
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    graph = HandStarted(folder, **values)
    try:
        for role in topics.NODES:
            more = {"checkpoint_file": str(folder / "estimate.json")}
            graph.start(role, **(more if role == topics.NAVIGATION else {}))
        graph.until(lambda: graph.moves(0.0), 90.0)
        yield graph
    finally:
        graph.close()
