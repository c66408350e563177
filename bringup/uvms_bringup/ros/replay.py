"""`uvms replay`: publishes a log again with /clock, or replays it into one node."""

import math
import os
import time
from pathlib import Path

from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.task import Future

from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.schema import qos_from_yaml
from uvms_bringup.errors import RunError
from uvms_bringup.progress import ProgressLine
from uvms_bringup.ros.metronome import Metronome
from uvms_bringup.ros.node_replay import replay_into
from uvms_bringup.ros.recorder import stamp_of
from uvms_core import topics
from uvms_core.ros.convert import interface_class
from uvms_core.ros.spin import Spinner, start
from uvms_core.ros.subscribe import qos_profile

DISCOVERY_S = 3.5
"""Least wall time for subscribers to find the publishers: DDS announces itself every 3 s."""
DISCOVERY_PATIENCE_S = 8.0
"""Most wall time for that, and for subscribers to take the last messages."""
LEAST_SLEEP_S = 1e-3
MESSAGES_A_SPIN = 200


def replay(
    log: str | Path,
    into: str | None = None,
    rate: float | None = None,
    output: str | Path | None = None,
) -> int:
    """Play a log again; returns the exit code.

    Args:
        log: MCAP file of a run.
        into: node to replay its recorded inputs into; None: publish everything.
        rate: speed against real time; 0: as fast as possible. None: 1, or 0 with `into`.
        output: folder for what that node answers; None: beside the log.

    Raises:
        RunError: the rate is negative or not finite, there is no such node, or it does not answer.
        LogError: the log cannot be read or lacks what is needed.
    """
    if rate is not None and not 0.0 <= rate < math.inf:  # refuses nan, too
        raise RunError(f"--rate {rate:g}: choose 0 (as fast as possible) or a finite factor above")
    if into is not None and into not in topics.NODES:
        raise RunError(f"--into {into!r}: choose one of {', '.join(topics.NODES)}")
    run = RunLog.open(log)
    if run.fault:
        print(f"{run.path}: {run.fault}; going on with what is whole", flush=True)
    if into is not None:
        folder = Path(output) if output is not None else run.path.parent / f"replay-{into}"
        return replay_into(run, into, rate or 0.0, folder)
    return publish(run, 1.0 if rate is None else rate)


def message_type(type_name: str) -> type | None:
    """The class of a message type; None if it is not installed."""
    try:
        return interface_class(type_name)
    except (ImportError, AttributeError):
        return None


class Player(Node):
    """Publishes recorded bytes on their topics."""

    def __init__(self, run: RunLog) -> None:
        super().__init__("replay")
        self.missing: list[str] = []
        self._publishers_of: dict[str, Publisher] = {}
        for name, type_name in run.topics.items():
            if name == topics.ROSOUT.name:  # what its nodes said then; this node has its own
                continue
            cls = message_type(type_name)
            if cls is None:
                self.missing.append(f"{name} ({type_name} is not installed)")
                continue
            qos = qos_from_yaml(run.channel(name)[2].get("offered_qos_profiles", ""))
            self._publishers_of[name] = self.create_publisher(cls, name, qos_profile(qos))

    def play(self, name: str, data: bytes) -> None:
        """Publish one message as it was recorded."""
        publisher = self._publishers_of.get(name)
        if publisher is not None:
            publisher.publish(data)

    def found_all(self) -> bool:
        """Whether every subscriber in the graph has been matched."""
        return all(
            publisher.get_subscription_count() >= self.count_subscribers(name)
            for name, publisher in self._publishers_of.items()
        )

    def flush(self) -> None:
        """Wait until the subscribers have acknowledged what is in flight."""
        for publisher in self._publishers_of.values():
            publisher.wait_for_all_acked(Duration(seconds=DISCOVERY_PATIENCE_S))


def _await_subscribers(player: Player, spinner: Spinner) -> None:
    # Messages published before a subscriber is matched are lost to it.
    end = time.monotonic() + DISCOVERY_PATIENCE_S
    spinner.spin_for(Future(), DISCOVERY_S)
    while not player.found_all() and time.monotonic() < end and not spinner.done.done():
        spinner.spin_for(Future(), 0.05)


def publish(run: RunLog, rate: float) -> int:
    """Publish every topic of a log in its order, paced by its clock."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    start(["uvms"])
    player = Player(run)
    spinner = Spinner([player])
    for lack in player.missing:
        print(f"left out: {lack}", flush=True)
    line = ProgressLine(_end_of(run))
    try:
        _await_subscribers(player, spinner)
        return _publish_all(run, player, spinner, Metronome(rate), line)
    finally:
        line.end()
        spinner.shutdown()


def _publish_all(
    run: RunLog, player: Player, spinner: Spinner, metronome: Metronome, line: ProgressLine
) -> int:
    clock = run.full_name(topics.CLOCK)
    clocked = clock in run.topics
    now = 0
    for count, (name, stamp, data) in enumerate(run.raw()):
        # A reference is stamped ahead of the tick that it comes in, so the clock alone sets the
        # pace where there is one.
        if name == clock or not clocked:
            now = max(now, stamp_of(data) if clocked else stamp)
            line.show(now, "")
        ahead = metronome.ahead(now)
        if ahead > LEAST_SLEEP_S or count % MESSAGES_A_SPIN == 0:
            spinner.spin_for(Future(), max(ahead, 0.0))
        if spinner.done.done():
            return 130
        player.play(name, data)
    player.flush()
    return 0


def _end_of(run: RunLog) -> int:
    end = 0
    clock = run.full_name(topics.CLOCK)
    for _, stamp, _ in run.raw([clock] if clock in run.topics else None):
        end = max(end, stamp)
    if not end:
        raise LogError(f"log {run.path}: has no messages to play")
    return end
