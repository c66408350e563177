"""`uvms run`: the nodes on a real ROS 2 graph, conducted and recorded from first to last tick."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

from uvms_bringup.cast import Cast
from uvms_bringup.errors import RunError
from uvms_bringup.pace import Pace
from uvms_bringup.ros.conductor import Conductor
from uvms_bringup.ros.parameter_file import node_parameters, write_parameter_file
from uvms_bringup.ros.processes import NodeProcesses, environment, node_command
from uvms_bringup.ros.recorder import Write
from uvms_bringup.scenario import Scenario
from uvms_core import registry, topics
from uvms_core.ros.node import UvmsNode
from uvms_core.ros.spin import Spinner, start
from uvms_core.signals import JointGoal, PathGoal, to_nanoseconds
from uvms_core.vehicle import Vehicle

OURS = Cast()
Progress = Callable[[int, str], None]
Parameters = dict[str, dict[str, Any]]


def run_graph(
    scenario: Scenario,
    vehicle: Vehicle,
    goal: PathGoal | JointGoal | None,
    pace: Pace,
    cast: Cast,
    composed: bool,
    folder: Path,
    write: Write,
    progress: Progress,
) -> bool:
    """Run a scenario on the node graph; True if it came to its end.

    Args:
        vehicle: of the run, with the scenario's overrides.
        cast: which node fills which role.
        composed: all nodes in this process, on one executor.
        folder: of this run, with `vehicle.yaml` in it; the nodes' parameters and logs go there.
        write: takes every message, as `Recorder` says.
        progress: called with the simulation stamp in ns and a line of text.

    Raises:
        RunError: a node died, did not come up, or the planner rejected the goal.
        PluginError: a node cannot be imported.
    """
    foreign = foreign_roles(cast)
    parameters = node_parameters(scenario, folder / "vehicle.yaml", pace)
    values = environment(folder / "logs")
    os.environ.update(values)
    print(f"ROS_DOMAIN_ID={values['ROS_DOMAIN_ID']} (set it to listen in)", flush=True)
    _print_contracts(cast, vehicle)
    start(["uvms"])
    nodes = _composed if composed else _separate
    with nodes({role: parameters[role] for role in cast.started}, cast, folder, values) as group:
        inside, watch = group
        conductor = Conductor(
            write,
            watch,
            vehicle.joint_names,
            topics.of(vehicle),
            topics.nodes(vehicle),
            foreign,
            patient=bool(cast.absent),
            namespace=cast.namespace or None,
        )
        conductor.broadcast(vehicle, pace.name == "lockstep")
        spinner = Spinner([conductor, *inside])
        try:
            conductor.conduct(spinner, goal)
            return _follow(conductor, spinner, to_nanoseconds(scenario.duration_s), watch, progress)
        finally:
            spinner.shutdown()


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


def _print_contracts(cast: Cast, vehicle: Vehicle) -> None:
    graph = topics.nodes(vehicle)
    for role in sorted(cast.absent):
        interface = topics.contract(role, graph, cast.namespace)
        print(f"{role} is left to you; it\n{interface}", flush=True)


def _follow(
    conductor: Conductor, spinner: Spinner, end: int, watch: Callable[[], None], progress: Progress
) -> bool:
    def look() -> bool:
        watch()
        progress(conductor.stamp, conductor.progress())
        return conductor.arrived(end)

    spinner.spin(until=look)
    return conductor.stamp >= end and not _failed(conductor)


def _failed(conductor: Conductor) -> bool:
    return conductor.result is not None and not conductor.result.success


Group = tuple[list[Node], Callable[[], None]]
"""Nodes inside this process, and what raises where one of the others has died."""


@contextmanager
def _separate(
    parameters: Parameters, cast: Cast, folder: Path, values: dict[str, str]
) -> Iterator[Group]:
    processes = NodeProcesses(folder / "logs", values)
    print(f"starting {len(parameters)} nodes ...", file=sys.stderr, flush=True)
    try:
        for role, own in parameters.items():
            file = write_parameter_file(folder / "parameters" / f"{role}.yaml", role, own)
            command = node_command(role, file, cast.namespace, cast.node_of(role))
            processes.start(role, command)
        yield [], processes.check
    finally:
        processes.stop()


@contextmanager
def _composed(
    parameters: Parameters, cast: Cast, folder: Path, values: dict[str, str]
) -> Iterator[Group]:
    nodes = [make_node(role, own, cast) for role, own in parameters.items()]
    yield nodes, lambda: None


def make_node(role: str, parameters: dict[str, Any], cast: Cast = OURS) -> Node:
    """The node of a role inside this process, with its parameters.

    Raises:
        RunError: its class does not take the options of rclpy.node.Node.
    """
    name = cast.node_of(role)
    make = registry.load(registry.NODES, name)
    overrides = [Parameter(key, value=value) for key, value in parameters.items()]
    if not rclpy.ok():
        raise RunError("ROS was shut down before the nodes were made")
    options = ["--ros-args", "-r", f"__node:={role}"]
    if cast.namespace:
        options += ["-r", f"__ns:=/{cast.namespace}"]
    try:
        return make(parameter_overrides=overrides, cli_args=options)
    except TypeError as fault:
        raise RunError(
            f"{role}: {name} cannot be composed: {fault}; its __init__ must take **options and hand"
            " them to rclpy.node.Node"
        ) from fault
