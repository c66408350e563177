"""The `main` of every node's executable."""

import sys
from collections.abc import Callable, Sequence

import rclpy
from rclpy.node import Node

from uvms_dynamics.config import Config
from uvms_dynamics.errors import UvmsError
from uvms_dynamics.ros.node import NodeConfig
from uvms_dynamics.ros.parameters import describe
from uvms_dynamics.ros.spin import Spinner, start


def main_of(
    make: Callable[[], Node],
    description: str,
    models: Sequence[type[Config]],
    args: Sequence[str] | None = None,
) -> int:
    """The `main` of a node's executable: help, start, spin, shut down; errors in one clear line."""
    args = list(sys.argv[1:] if args is None else args)
    if "-h" in args or "--help" in args:
        print(help_text(description, models))
        return 0
    start([sys.argv[0], *args])
    try:
        spinner = Spinner([make()])
    except UvmsError as fault:
        print(f"error: {fault}", file=sys.stderr)
        rclpy.try_shutdown()
        return 2
    try:
        spinner.spin()
    except UvmsError as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    finally:
        spinner.shutdown()
    return 0


def help_text(description: str, models: Sequence[type[Config]]) -> str:
    """What a node's `--help` prints."""
    return (
        f"{description.strip()}\n\n"
        "Set a parameter with --ros-args -p NAME:=VALUE, or several with --params-file FILE.\n\n"
        f"parameters of every node (default, range):\n{describe(NodeConfig)}\n\n"
        f"parameters of this node (default, range):\n{describe(*models)}"
    )
