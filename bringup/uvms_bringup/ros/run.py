"""`uvms run`: the nodes on a real ROS 2 graph, conducted and recorded from first to last tick."""

import os
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from rclpy.node import Node

from uvms_bringup.agenda import Goals
from uvms_bringup.cast import Cast
from uvms_bringup.claim import Holder
from uvms_bringup.ending import Ending
from uvms_bringup.errors import RunError, ScenarioError
from uvms_bringup.pace import Pace
from uvms_bringup.ros.acknowledge import window_for
from uvms_bringup.ros.conductor import Conductor
from uvms_bringup.ros.domain import claim_domain, may_have_others
from uvms_bringup.ros.parameter_file import node_parameters
from uvms_bringup.ros.plant_watch import PlantWatch
from uvms_bringup.ros.processes import environment
from uvms_bringup.ros.recorder import Write
from uvms_bringup.ros.run_nodes import ComposedNodes, RunNodes, SeparateNodes
from uvms_bringup.scenario import Scenario
from uvms_bringup.stopped import Stopped
from uvms_core import registry, topics
from uvms_core.ros.node import UvmsNode
from uvms_core.ros.spin import Spinner, start
from uvms_core.signals import to_nanoseconds, to_seconds
from uvms_core.vehicle import Vehicle
from uvms_dynamics.simulation import PlantConfig
from uvms_dynamics.simulation.events import EventsConfig

Progress = Callable[[int, str], None]
QUIET_S = 0.3
"""Wall time after the nodes' end until what they leave behind in the middleware is cleared up; to
leave ROS at the same moment can deadlock (`Spinner.shutdown`)."""


class ForeignError(RunError):
    """Somebody who does not belong to the run took part in it."""


@dataclass(frozen=True)
class GraphRun:
    """A run on the graph.

    Args:
        vehicle: of the run, with the scenario's overrides.
        cast: which node fills which role.
        composed: all nodes in this process, on one executor.
        respawn: start a node that dies again, if it is not the plant.
        folder: of this run, with `vehicle.yaml` in it; the nodes' parameters and logs go there.
        holder: who runs it, for others who want its domain.
        write: takes every message, as `Recorder` says.
        progress: called with the simulation stamp in ns and what the run is at.
        waiting: called while no time passes, with what says what is missing.
        ending: is filled with what happened, whatever ends the run.
    """

    scenario: Scenario
    vehicle: Vehicle
    goal: Goals
    pace: Pace
    cast: Cast
    composed: bool
    respawn: bool
    folder: Path
    holder: Holder
    write: Write
    progress: Progress
    waiting: Callable[[Callable[[], str]], None] = lambda lack: None
    ending: Ending = field(default_factory=Ending)

    def run(self) -> None:
        """Run to the end.

        Raises:
            RunError: a node died or did not come up, the planner rejected the goal, or somebody
                else is in the graph.
            PluginError: a node cannot be imported.
            ScenarioError: it asks of a plant that is not ours what only ours does.
            Stopped: by a signal.
        """
        foreign = foreign_roles(self.cast)
        check_own_plant(self.cast, self.scenario)
        values = environment(self.folder / "logs")
        claim = claim_domain(values, self.holder)
        try:
            os.environ.update(values)
            print(f"ROS_DOMAIN_ID={values['ROS_DOMAIN_ID']} (set it to listen in)", flush=True)
            _print_contracts(self.cast, self.vehicle)
            others = may_have_others(values)  # asked before this process is in the domain
            start(["uvms"])
            self._with_nodes(values, foreign, others)
        finally:
            if claim is not None:
                claim.release()

    def _with_nodes(self, values: dict[str, str], foreign: frozenset[str], others: bool) -> None:
        nodes = self._run_nodes(values)
        try:
            conductor = self._conductor(nodes, foreign)
            spinner = Spinner([conductor])
            try:
                self._conduct(nodes, conductor, spinner, others)
            finally:
                self._take_stock(conductor, spinner)
                nodes.stop()
                time.sleep(QUIET_S)
                spinner.shutdown()
        finally:
            nodes.stop()

    def _conductor(self, nodes: RunNodes, foreign: frozenset[str]) -> Conductor:
        conductor = Conductor(
            self.write,
            lambda: self._watch(nodes, conductor),
            self.vehicle.joint_names,
            (*topics.of(self.vehicle), *topics.GAPS, topics.ROSOUT),
            topics.nodes(self.vehicle),
            foreign,
            self.cast.absent,
            self.waiting,
            namespace=self.cast.namespace or None,
        )
        return conductor

    def _run_nodes(self, values: dict[str, str]) -> RunNodes:
        parameters = node_parameters(
            self.scenario, self.folder / "vehicle.yaml", self.pace, self.holder.run_id
        )
        if self._in_lockstep:
            parameters[topics.PLANT]["recorder_window"] = self._window
        if self.respawn:
            checkpoint = self.folder / "navigation_checkpoint.json"
            parameters[topics.NAVIGATION]["checkpoint_file"] = str(checkpoint)
        own = {role: parameters[role] for role in self.cast.started}
        if self.composed:
            return ComposedNodes(own, self.cast)
        return SeparateNodes(own, self.cast, self.folder, values, self.respawn)

    @property
    def _in_lockstep(self) -> bool:
        return self.pace.name == "lockstep"

    @property
    def _period(self) -> int:
        return to_nanoseconds(self.scenario.plant.control_period_s)

    @property
    def _window(self) -> int:
        return window_for(self.vehicle, self._period)

    def _conduct(
        self, nodes: RunNodes, conductor: Conductor, spinner: Spinner, others: bool
    ) -> None:
        conductor.check_alone(spinner, others)
        conductor.broadcast(self.vehicle, self._in_lockstep)
        if self._in_lockstep:
            sampled = topics.sampled_topics(self.vehicle)
            conductor.acknowledge(self._period, self._window, sampled)
        spinner.add(nodes.enter())
        conductor.conduct(spinner, self.goal)
        plant_watch = PlantWatch(conductor, conductor.recorder)
        end = to_nanoseconds(self.scenario.duration_s)

        def look() -> bool:
            self._watch(nodes, conductor)
            plant_watch.check()
            conductor.go_on()
            self.progress(conductor.stamp, conductor.phase())
            return conductor.arrived(end)

        spinner.spin(until=look)
        if spinner.signal:
            raise Stopped(spinner.signal)

    def _watch(self, nodes: RunNodes, conductor: Conductor) -> None:
        """Notice deaths and intruders; raise where the run cannot go on."""
        for role, how in nodes.respawn_dead():
            conductor.graph_watch.expect_again(role)
            conductor.losses.restart(role)
            if role == topics.MOTION_PLANNER:
                conductor.ask_again()
            when = to_seconds(conductor.stamp)
            self.ending.incidents.append(f"t = {when:.2f} s: {how}; started again")
        conductor.losses.look()
        if conductor.acknowledgement is not None:
            conductor.acknowledgement.look_after()
        if conductor.recorder.set_back is not None:
            before, after = map(to_seconds, conductor.recorder.set_back)
            text = f"somebody set /clock back from {before:.2f} s to {after:.2f} s"
            self.ending.foreign = (*conductor.graph_watch.foreign, text)
            raise ForeignError(text)
        if conductor.stamp and conductor.graph_watch.look():
            self.ending.foreign = conductor.graph_watch.foreign
            raise ForeignError(
                f"somebody else took part: {'; '.join(self.ending.foreign)}. End whoever does not"
                " belong, or give the run a ROS_DOMAIN_ID of its own"
            )

    def _take_stock(self, conductor: Conductor, spinner: Spinner) -> None:
        """What the log does not show; only of a run that began."""
        conductor.hear()
        self.ending.goal, self.ending.goals = conductor.agenda.state, conductor.agenda.records()
        if topics.CLOCK.name not in conductor.recorder.newest:
            return
        self.ending.incidents += conductor.interference()
        self.ending.incidents += conductor.goal_failure()
        silent = conductor.count(spinner)
        self.ending.incidents += [
            f"{role} did not say at the end how many messages it had sent" for role in silent
        ]
        if conductor.acknowledgement is not None:
            self.ending.incidents += conductor.acknowledgement.given_up
        self.ending.sent, self.ending.lost = conductor.losses.sent(), conductor.losses.lost()


def foreign_roles(cast: Cast) -> frozenset[str]:
    """Roles whose nodes do not answer to the roll call: left to the user, or not a `UvmsNode`.

    Raises:
        PluginError: a node cannot be imported, or is no node.
    """
    chosen = {role: registry.load(registry.NODES, node) for role, node in cast.nodes.items()}
    for role, make in chosen.items():
        if not (isinstance(make, type) and issubclass(make, Node)):
            raise RunError(f"--node {role}={cast.nodes[role]}: is no subclass of rclpy.node.Node")
    return cast.absent | {r for r, make in chosen.items() if not issubclass(make, UvmsNode)}


def check_own_plant(cast: Cast, scenario: Scenario) -> None:
    """Refuse what a plant that the user brings would ignore, and the log would claim.

    Raises:
        ScenarioError: the scenario has events, or a plant that differs from the model, and the
            node does not have the parameters for them.
    """
    if topics.PLANT not in cast.nodes:
        return
    make = registry.load(registry.NODES, cast.nodes[topics.PLANT])
    taken, plant = getattr(make, "configurations", ()), scenario.plant
    for name, config, value in (
        ("events", EventsConfig, scenario.events),
        ("plant.vehicle_overrides", PlantConfig, plant.vehicle_overrides),
        ("plant.mismatch", PlantConfig, any(half for _, half in plant.mismatch)),
    ):
        if value and config not in taken:
            raise ScenarioError(
                f"{name}: --node {topics.PLANT}={cast.nodes[topics.PLANT]} takes no"
                f" {config.__name__}, and would ignore it; leave it out, or list {config.__name__}"
                " in the node's `configurations`"
            )


def _print_contracts(cast: Cast, vehicle: Vehicle) -> None:
    graph = topics.nodes(vehicle)
    for role in sorted(cast.absent):
        interface = topics.contract(role, graph, cast.namespace)
        print(f"{role} is left to you; it\n{interface}", flush=True)
