"""One run from its scenario to its folder: run.mcap, config.yaml, summary.json."""

import json
import os
import subprocess
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from uvms_analysis.log import plant_record, run_end
from uvms_analysis.log.encode import SignalWriter
from uvms_analysis.log.goal_file import path_to_json
from uvms_analysis.log.memory import MemoryWriter
from uvms_analysis.log.read import RUN
from uvms_analysis.log.writer import LogWriter
from uvms_analysis.summary import summarise
from uvms_bringup.agenda import Agenda, Goals, path_of
from uvms_bringup.cast import Cast
from uvms_bringup.claim import Claim, Holder
from uvms_bringup.ending import Ending
from uvms_bringup.errors import RunError
from uvms_bringup.folder import claim_folder, new_folder
from uvms_bringup.pace import Pace
from uvms_bringup.run_id import new_run_id
from uvms_bringup.scenario import Scenario
from uvms_bringup.simulate import simulate
from uvms_bringup.stopped import SignalWatch, Stopped
from uvms_bringup.terminal.heard_log import HeardLog
from uvms_bringup.terminal.listener import Listener
from uvms_bringup.terminal.screen import Screen
from uvms_core.errors import UvmsError
from uvms_core.signals import to_nanoseconds
from uvms_core.vehicle import Vehicle, dump_vehicle
from uvms_core.yaml_text import dump_yaml
from uvms_dynamics.simulation.plant.as_built import AsBuilt, as_built
from uvms_planner.errors import GoalRejected

VEHICLE_FILE = "vehicle.yaml"
BAG_FILE = "metadata.yaml"
SUMMARY_FILE = "summary.json"
Progress = Callable[[int, str], None]
Run = Callable[[LogWriter, Ending, Progress, Screen], None]


class Stopwatch:
    """Wall time of a run's two parts: until simulated time starts, and from then on."""

    def __init__(self) -> None:
        self._made = time.perf_counter()
        self._started: float | None = None
        self._stopped = self._made

    def start(self) -> None:
        """Simulated time starts with the first call."""
        if self._started is None:
            self._started = time.perf_counter()

    def stop(self) -> None:
        """The run is over."""
        self._stopped = time.perf_counter()

    @property
    def start_up_s(self) -> float:
        """Set-up of the nodes, and compilation where kernels are not compiled yet."""
        return (self._stopped if self._started is None else self._started) - self._made

    @property
    def run_s(self) -> float:
        """From the start of simulated time to the end."""
        return 0.0 if self._started is None else self._stopped - self._started


@dataclass(frozen=True)
class Session:
    """A run that is ready to start."""

    scenario: Scenario
    vehicle: Vehicle
    goal: Goals
    folder: Path
    pace: str
    command: str
    holder: Holder
    claim: Claim
    cast: Cast = field(default_factory=Cast)
    quiet: bool = False
    ended_by: list[UvmsError] = field(default_factory=list)
    """What ended the run before its end; filled while it runs."""

    def run_simulation(self) -> dict[str, Any]:
        """`uvms simulate`: returns the summary; as `run_graph`."""

        def run(log: LogWriter, ending: Ending, progress: Progress, screen: Screen) -> None:
            names = self.vehicle.joint_names, self.vehicle.thruster_names
            writer = SignalWriter(log, *names, self.cast.namespace)
            simulate_goal(self.scenario, self.vehicle, self.goal, writer, ending, progress)
            ending.sent = log.counts  # what is computed here is written here

        return self._record(run)

    def run_graph(self, pace: Pace, composed: bool, respawn: bool = False) -> dict[str, Any]:
        """`uvms run`: returns the summary.

        Raises:
            Stopped: a signal ended the run; what was recorded is in its folder.
            UvmsError: the run never began.
        """
        from uvms_bringup.ros.run import GraphRun  # only this needs ROS

        def run(log: LogWriter, ending: Ending, progress: Progress, screen: Screen) -> None:
            GraphRun(
                self.scenario,
                self.vehicle,
                self.goal,
                pace,
                self.cast,
                composed,
                respawn,
                self.folder,
                self.holder,
                log.write,
                progress,
                screen.wait,
                ending,
            ).run()

        return self._record(run)

    def _record(self, run: Run) -> dict[str, Any]:
        config = effective_config(self.scenario)
        (self.folder / "config.yaml").write_text(config, encoding="utf-8")
        vehicle_file(self.folder, self.vehicle)
        clock, ending, fault = Stopwatch(), Ending(), None
        screen, open_log = self._watched()
        try:
            with SignalWatch() as signals, open_log() as log:

                def progress(stamp: int, note: str) -> None:
                    clock.start()
                    signals.begin()
                    signals.check()
                    screen.show(stamp, note)

                try:
                    self._describe(log, config)
                    with screen:
                        run(log, ending, progress, screen)
                except UvmsError as reason:
                    fault = reason
                    self.ended_by.append(reason)
                finally:
                    clock.stop()
                self._end(log, ending, fault)
            return self._conclude(log.path, clock, fault)
        finally:
            self.claim.release()

    def _watched(self) -> tuple[Screen, Callable[[], LogWriter]]:
        """What is shown of the run, and how its log is opened so that this hears of it."""
        file, end = self.folder / "run.mcap", to_nanoseconds(self.scenario.duration_s)
        if self.quiet:
            return Screen("", end, None), lambda: LogWriter(file)
        limits = self.scenario.planner.limits
        listener = Listener(self.vehicle, limits, self.cast.namespace)
        title = f"{self.scenario.scenario} {self.holder.run_id}"
        return Screen(title, end, listener), lambda: HeardLog(file, listener.hear)

    def _end(self, log: LogWriter, ending: Ending, fault: Exception | None) -> None:
        """The last record; LogError where the log cannot be written any more."""
        stopped_by = fault.name if isinstance(fault, Stopped) else str(fault or "")
        end = ending.record(self.scenario.duration_s, stopped_by)
        log.metadata(run_end.NAME, end.to_metadata())
        log.close()

    def _conclude(self, log: Path, clock: Stopwatch, fault: Exception | None) -> dict[str, Any]:
        """The summary; a run that never began leaves no log."""
        began = clock.run_s > 0.0 and not isinstance(fault, GoalRejected)
        if fault is not None and not began:
            for file in (log, log.parent / BAG_FILE):
                file.unlink(missing_ok=True)
            raise fault
        summary = self._summarise(clock)
        if isinstance(fault, Stopped):
            raise fault
        return summary

    def _describe(self, log: LogWriter, config: str) -> None:
        log.attach("config.yaml", config, "application/yaml")
        log.attach(VEHICLE_FILE, dump_vehicle(self.vehicle), "application/yaml")
        built = as_built(self.vehicle, self.scenario.plant, self.scenario.seed)
        if built.differs:
            log.attach(plant_record.VEHICLE_FILE, dump_vehicle(built.vehicle), "application/yaml")
        if (path := path_of(self.goal)) is not None:
            log.attach("path.json", path_to_json(path), "application/json")
        records = run_records(self.scenario, built, self.pace, self.command, self.holder.run_id)
        for name, record in records.items():
            log.metadata(name, record)

    def _summarise(self, clock: Stopwatch) -> dict[str, Any]:
        summary: dict[str, Any] = {"run_id": self.holder.run_id}
        summary |= summarise(self.folder / "run.mcap", wall_s=clock.run_s)
        summary["start_up_s"] = clock.start_up_s
        text = json.dumps(summary, indent=2)
        (self.folder / SUMMARY_FILE).write_text(text + "\n", encoding="utf-8")
        return summary


def simulate_goal(
    scenario: Scenario,
    vehicle: Vehicle,
    goal: Goals,
    log: SignalWriter | MemoryWriter,
    ending: Ending,
    progress: Progress = lambda stamp, text: None,
) -> None:
    """`simulate`, noting what became of the goal."""
    agenda = Agenda(goal)
    try:
        simulate(scenario, vehicle, agenda, log, progress)
    finally:
        ending.goal, ending.goals = agenda.state, agenda.records()


def run_records(
    scenario: Scenario, built: AsBuilt, pace: str, command: str = "", run_id: str = ""
) -> dict[str, dict[str, str]]:
    """Metadata records by name: what a log says about its run, and about a plant that differs."""
    run = {
        "scenario": scenario.scenario,
        "seed": str(scenario.seed),
        "git_revision": git_revision(),
        "version": version("uvms_bringup"),
        "pace": pace,
        "command": command,
        "run_id": run_id,
    }
    if not built.differs:
        return {RUN: run}
    return {RUN: run, plant_record.NAME: plant_record.to_metadata(built.to_data())}


def prepare(
    scenario: Scenario, output: str | None, pace: str, command: str, cast: Cast | None = None
) -> Session:
    """Load the vehicle, make the goal, and make and claim the run's folder.

    Raises:
        RunError: the folder cannot be made, or it belongs to another run.
    """
    vehicle = scenario.load_vehicle()
    scenario = scenario.for_vehicle(vehicle)
    goal = scenario.build_goals(vehicle)
    holder = Holder(new_run_id(), os.getpid(), command)
    if output == "":
        raise RunError("--output '': give the name of a folder")
    folder = Path(output) if output else new_folder(scenario.scenario)
    folder, claim = claim_folder(folder, holder)
    return Session(scenario, vehicle, goal, folder, pace, command, holder, claim, cast or Cast())


def effective_config(scenario: Scenario) -> str:
    """The scenario as YAML that runs again with the `vehicle.yaml` beside it, wherever they are."""
    changes = (f"{path}={value}" for path, value in scenario.vehicle_overrides.items())
    origin = " with ".join(filter(None, (scenario.vehicle, ", ".join(changes))))
    origin = " ".join(origin.split())  # a comment is one line
    return f"# {VEHICLE_FILE}: {origin}\n{dump_yaml(effective_values(scenario))}"


def effective_values(scenario: Scenario) -> dict[str, Any]:
    """The scenario as plain data; its vehicle is that of the file beside it."""
    own = scenario.model_copy(update={"vehicle": VEHICLE_FILE, "vehicle_overrides": {}})
    return own.model_dump(mode="json")


def vehicle_file(folder: Path, vehicle: Vehicle) -> Path:
    """Write the vehicle as the nodes of a run read it: with the scenario's overrides."""
    path = folder / VEHICLE_FILE
    path.write_text(dump_vehicle(vehicle), encoding="utf-8")
    return path


@cache
def git_revision() -> str:
    """Revision of the sources in use, `unknown` outside a repository; `+` marks local changes."""
    here = Path(__file__).resolve().parent
    command = ["git", "-C", str(here), "describe", "--always", "--dirty=+", "--abbrev=12"]
    try:
        found = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return found.stdout.strip()
