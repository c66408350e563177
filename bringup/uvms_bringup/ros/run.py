"""`uvms run`: the six nodes on a real ROS 2 graph, led and recorded from first to last tick."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

from uvms_bringup.errors import RunError
from uvms_bringup.pace import Pace
from uvms_bringup.ros.conductor import Conductor
from uvms_bringup.ros.parameter_file import node_parameters, write_parameter_file
from uvms_bringup.ros.processes import NodeProcesses, environment, node_command
from uvms_bringup.ros.recorder import Write
from uvms_bringup.scenario import Scenario
from uvms_core import registry, topics
from uvms_core.ros.spin import Spinner, start
from uvms_core.signals import JointGoal, PathGoal, to_nanoseconds

Progress = Callable[[int, str], None]


def run_graph(
    scenario: Scenario,
    goal: PathGoal | JointGoal | None,
    pace: Pace,
    composed: bool,
    folder: Path,
    write: Write,
    progress: Progress,
) -> bool:
    """Run a scenario on the node graph; True if it came to its end.

    Args:
        folder: of this run, with `vehicle.yaml` in it; the nodes' parameters and logs go there.
        write: takes every message, as `Recorder` says.
        progress: called with the simulation stamp in ns and a line of text.

    Raises:
        RunError: a node died, did not come up, or the planner rejected the goal.
    """
    parameters = node_parameters(scenario, folder / "vehicle.yaml", pace)
    values = environment(folder / "logs")
    os.environ.update(values)
    print(f"ROS_DOMAIN_ID={values['ROS_DOMAIN_ID']} (set it to listen in)", flush=True)
    start(["uvms"])
    nodes = _composed if composed else _separate
    with nodes(parameters, folder, values) as (inside, watch):
        vehicle = scenario.load_vehicle()
        conductor = Conductor(write, watch, vehicle.joint_names, topics.of(vehicle))
        conductor.broadcast(vehicle, pace.name == "lockstep")
        spinner = Spinner([conductor, *inside])
        try:
            conductor.lead(spinner, goal)
            return _follow(conductor, spinner, to_nanoseconds(scenario.duration_s), watch, progress)
        finally:
            spinner.shutdown()


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


@contextmanager
def _separate(
    parameters: dict[str, dict], folder: Path, values: dict[str, str]
) -> Iterator[tuple[list[Node], Callable[[], None]]]:
    processes = NodeProcesses(folder / "logs", values)
    try:
        for node, own in parameters.items():
            file = write_parameter_file(folder / "parameters" / f"{node}.yaml", node, own)
            processes.start(node, node_command(node, file))
        yield [], processes.check
    finally:
        processes.stop()


@contextmanager
def _composed(
    parameters: dict[str, dict], folder: Path, values: dict[str, str]
) -> Iterator[tuple[list[Node], Callable[[], None]]]:
    nodes = [make_node(node, own) for node, own in parameters.items()]
    yield nodes, lambda: None


def make_node(node: str, parameters: dict) -> Node:
    """A node of the graph inside this process, with its parameters."""
    make = registry.load(registry.NODES, node)
    overrides = [Parameter(key, value=value) for key, value in parameters.items()]
    if not rclpy.ok():
        raise RunError("ROS was shut down before the nodes were made")
    return make(parameter_overrides=overrides)
