"""The nodes of a run, in processes of their own or composed in this one."""

import sys
from pathlib import Path
from typing import Any, Protocol

import rclpy
from rclpy.node import Node
from rclpy.parameter import Parameter

from uvms_bringup.cast import Cast
from uvms_bringup.errors import RunError
from uvms_bringup.ros.parameter_file import write_parameter_file
from uvms_bringup.ros.processes import NodeProcesses, node_command
from uvms_core import registry, topics

OURS = Cast()
Parameters = dict[str, dict[str, Any]]
"""Of the nodes, by role."""


class RunNodes(Protocol):
    """All nodes that a run starts."""

    def enter(self) -> list[Node]:
        """Let them into the graph; returns those inside this process."""

    def respawn_dead(self) -> list[tuple[str, str]]:
        """Roles whose node has died and was started again, with how it ended.

        Raises:
            RunError: a node has died that is not to be started again.
        """

    def stop(self) -> None:
        """End them."""


class ComposedNodes:
    """All in this process."""

    def __init__(self, parameters: Parameters, cast: Cast) -> None:
        self._parameters, self._cast = parameters, cast

    def enter(self) -> list[Node]:
        """Make the nodes."""
        return [make_node(role, own, self._cast) for role, own in self._parameters.items()]

    def respawn_dead(self) -> list[tuple[str, str]]:
        """None: they live and die with this process."""
        return []

    def stop(self) -> None:
        """Nothing to do: whoever spins them shuts them down."""


class SeparateNodes:
    """Each in a process of its own, started at once, so that all import at the same time."""

    def __init__(
        self,
        parameters: Parameters,
        cast: Cast,
        folder: Path,
        values: dict[str, str],
        respawn: bool,
    ) -> None:
        self._processes = NodeProcesses(folder / "logs", values)
        self._respawn = respawn
        print(f"starting {len(parameters)} nodes ...", file=sys.stderr, flush=True)
        try:
            for role, own in parameters.items():
                file = write_parameter_file(folder / "parameters" / f"{role}.yaml", role, own)
                command = node_command(role, file, cast.namespace, cast.node_of(role))
                self._processes.start(role, command)
        except BaseException:
            self._processes.stop()
            raise

    def enter(self) -> list[Node]:
        """Let them into the graph."""
        self._processes.release()
        return []

    def respawn_dead(self) -> list[tuple[str, str]]:
        """As `RunNodes` says; the plant is not started again, because time would start over."""
        if not self._respawn:
            self._processes.check()
            return []
        replaced = []
        for role in self._processes.dead():
            how = self._processes.exit_report(role)
            if role == topics.PLANT:
                raise RunError(how)
            self._processes.start_again(role)
            replaced.append((role, how.partition(":\n")[0]))
        return replaced

    def stop(self) -> None:
        """Stop the processes."""
        self._processes.stop()


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
