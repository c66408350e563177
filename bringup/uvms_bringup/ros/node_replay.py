"""`uvms replay --into NODE`: one real node gets its recorded inputs, tick by tick."""

import os
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from rclpy.task import Future
from std_srvs.srv import Trigger

from uvms_analysis.analysis import Analysis
from uvms_analysis.log.compare import compare, table
from uvms_analysis.log.read import RUN, RunLog
from uvms_analysis.log.writer import LogWriter
from uvms_bringup.claim import Holder
from uvms_bringup.errors import RunError, ScenarioError
from uvms_bringup.pace import Pace
from uvms_bringup.progress import ProgressLine
from uvms_bringup.ros.domain import claim_domain
from uvms_bringup.ros.goals_again import GoalsAgain
from uvms_bringup.ros.input_player import InputPlayer
from uvms_bringup.ros.metronome import Metronome
from uvms_bringup.ros.parameter_file import node_parameters, write_parameter_file
from uvms_bringup.ros.processes import NodeProcesses, environment, node_command
from uvms_bringup.ros.schedule import TickOf, TickRecord, schedule, with_gaps
from uvms_bringup.run_id import new_run_id
from uvms_bringup.scenario import Scenario
from uvms_core import topics
from uvms_core.config import validated
from uvms_core.ros.request import Request
from uvms_core.ros.spin import Spinner, start
from uvms_core.signals import to_nanoseconds, to_seconds

START_PATIENCE_S = 90.0
TICK_PATIENCE_S = 5.0
FIRST_PATIENCE_S = 60.0
FIRST_TICKS = 3
"""The first ticks may compile kernels."""
UNANSWERED = 3
"""The replay is aborted after this many ticks in a row without an answer."""
LOOK_S = 0.5
START_LOOK_S = 0.02
"""Wall time between two looks while something is to begin."""


class NodeReplay:
    """One node in a process of its own, and the player of its inputs beside it."""

    def __init__(self, run: RunLog, node: str, folder: Path, log: LogWriter) -> None:
        self.run, self.node = run, node
        self.scenario = validated(
            Scenario, run.configuration(), f"log {run.path}: config.yaml", ScenarioError
        )
        self._vehicle = Analysis(run).vehicle
        period = to_nanoseconds(self.scenario.plant.control_period_s)
        tick_of = TickOf(run, period, to_nanoseconds(self.scenario.planner.step_s))
        self.topics = with_gaps(run, self._topics_of(node))
        self.ticks = schedule(run, node, tick_of, self.topics)
        values = environment(folder / "logs")
        command = f"uvms replay {run.path} --into {node}"
        self._claim = claim_domain(values, Holder(new_run_id(), os.getpid(), command))
        os.environ.update(values)
        start(["uvms"])
        self._processes = NodeProcesses(folder / "logs", values)
        self._player = InputPlayer(run, node, self.topics, tick_of, log)
        self._goals = self._goals_of(node)
        self._spinner = Spinner([self._player])
        self._processes.start(node, self._command(folder))
        self._processes.release()

    def _topics_of(self, node: str) -> topics.NodeTopics:
        """What the node reads and writes in the recorded run."""
        own = topics.nodes(self._vehicle)[node]
        if node == topics.NAVIGATION and self.scenario.navigation.source == "truth":
            return replace(own, inputs=(*own.inputs, topics.TRUE_ODOMETRY))
        return own

    def _goals_of(self, node: str) -> GoalsAgain | None:
        if node != topics.MOTION_PLANNER:
            return None
        goals = self.scenario.build_goals(self._vehicle)
        return GoalsAgain(self._player, goals, self._vehicle.joint_names)

    def _command(self, folder: Path) -> list[str]:
        vehicle = folder / "vehicle.yaml"
        vehicle.write_text(self.run.text("vehicle.yaml"), encoding="utf-8")
        parameters = node_parameters(self.scenario, vehicle, Pace())[self.node]
        if self.node == topics.PLANT:
            parameters["start_paused"] = False
        file = write_parameter_file(folder / f"{self.node}.yaml", self.node, parameters)
        return node_command(self.node, file, self.run.namespace)

    def close(self) -> None:
        """Stop the node."""
        self._processes.stop()
        self._spinner.shutdown()
        if self._claim is not None:
            self._claim.release()

    def connect(self) -> None:
        """Wait until the node and the player are connected."""
        deadline = time.monotonic() + START_PATIENCE_S
        while not self._player.connected():
            self._check()
            if time.monotonic() > deadline:
                raise RunError(
                    f"timed out after {START_PATIENCE_S:.0f} s: {self.node}: {self._player.lack}"
                )
            self._spinner.spin_for(Future(), START_LOOK_S)
        if self.node == topics.PLANT:
            self._start_plant()
        if self._goals is not None:
            self._wait_until(self._goals.begin, "the planner does not wait for goals")

    def _start_plant(self) -> None:
        client = self._player.create_client(Trigger, "start")
        request = Request(lambda: client.call_async(Trigger.Request()), client.service_is_ready)
        self._wait_until(lambda: request.answer() is not None, "the plant did not start")

    def _wait_until(self, ready: Callable[[], bool], lack: str) -> None:
        deadline = time.monotonic() + START_PATIENCE_S
        while not ready():
            self._check()
            if time.monotonic() > deadline:
                raise RunError(f"timed out after {START_PATIENCE_S:.0f} s: {lack}")
            self._spinner.spin_for(Future(), START_LOOK_S)

    def all_ticks(self, metronome: Metronome, line: ProgressLine) -> int:
        """Play tick by tick; returns how many were left unanswered."""
        unanswered = in_a_row = 0
        for number, tick in enumerate(self.ticks):
            ahead = metronome.ahead(tick.stamp)
            if ahead > 0.0:
                self._spinner.spin_for(Future(), ahead)
            patience = FIRST_PATIENCE_S if number < FIRST_TICKS else TICK_PATIENCE_S
            answered = self._one(tick, patience)
            in_a_row = 0 if answered else in_a_row + 1
            unanswered += not answered
            if in_a_row >= UNANSWERED:
                self._give_up(tick)
            line.show(tick.stamp, f"{unanswered} ticks unanswered" if unanswered else "")
        return unanswered

    def _one(self, tick: TickRecord, patience: float) -> bool:
        if self.node == topics.PLANT:  # it publishes first, then steps with the commands
            answered = self._await(self._player.answer_to(tick), patience)
            self._player.play(tick)
            return answered
        future = self._player.answer_to(tick)
        self._player.play(tick)
        return self._await(future, patience)

    def _await(self, future: Future, patience: float) -> bool:
        """Whether the answer came in this time, s; a planner gives none before it has its goal."""
        deadline = time.monotonic() + patience
        while not self._spinner.spin_for(future, self._look_s):
            self._check()
            if self._goals is not None and self._goals.is_awaited:
                self._goals.go_on()
                deadline = time.monotonic() + patience
            if time.monotonic() > deadline:
                return False
        return True

    @property
    def _look_s(self) -> float:
        is_awaited = self._goals is not None and self._goals.is_awaited
        return START_LOOK_S if is_awaited else LOOK_S

    def _check(self) -> None:
        self._processes.check()
        if self._spinner.done.done():
            raise RunError("stopped before the replay came to its end")

    def _give_up(self, tick: TickRecord) -> None:
        raise RunError(
            f"{self.node} did not answer at t = {to_seconds(tick.stamp):g} s; its output is "
            f"in {self._processes.log_of(self.node)}"
        )


def replay_into(run: RunLog, node: str, rate: float, folder: Path) -> int:
    """Replay into one node, record its outputs to `folder`/replay.mcap and print how they compare.

    Returns 0, or 1 if ticks were left unanswered.

    Raises:
        RunError: the node died, did not come up or does not answer.
        LogError: the log lacks the node's inputs or outputs, or the folder cannot be written.
    """
    with LogWriter(folder / "replay.mcap", overwrite=True) as log:
        for name, data in run.attachments.items():
            log.attach(name, data)
        log.metadata(RUN, dict(run.run) | {"replay_of": run.path.name, "replay_into": node})
        replay = NodeReplay(run, node, folder, log)
        line = ProgressLine(replay.ticks[-1].stamp)
        try:
            replay.connect()
            unanswered = replay.all_ticks(Metronome(rate), line)
        finally:
            line.end()
            replay.close()
    outputs = [topic for topic in replay.topics.outputs if run.has(topic)]
    print(table(compare(run, RunLog.open(folder / "replay.mcap"), outputs)))
    print(f"{len(replay.ticks)} ticks, {unanswered} unanswered; log: {folder / 'replay.mcap'}")
    return 1 if unanswered else 0
