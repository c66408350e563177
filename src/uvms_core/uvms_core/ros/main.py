"""The `main` of every node's executable, and `python -m uvms_core.ros.main NODE` for any node."""

import sys
from collections.abc import Callable, Sequence
from typing import Any

import rclpy
from rclpy.node import Node

from uvms_core import registry
from uvms_core.config import Config
from uvms_core.errors import UvmsError
from uvms_core.ros.lifeline import hold_on
from uvms_core.ros.node import NodeConfig
from uvms_core.ros.parameters import describe
from uvms_core.ros.spin import Spinner, start


def main_of(make: Callable[[], Node], args: Sequence[str] | None = None) -> int:
    """The `main` of a node's executable: help, start, spin, shut down; errors in one clear line.

    Args:
        make: class of the node. Its attribute `configurations`, where it has one, lists the
            configurations that it declares as parameters, for `--help`.
        args: command line without the program's name; None: that of the process.
    """
    args = list(sys.argv[1:] if args is None else args)
    if "-h" in args or "--help" in args:
        print(help_text(make))
        return 0
    hold_on()
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


def help_text(make: Any) -> str:
    """What a node's `--help` prints: its module's text, its own, and its parameters."""
    module = sys.modules[make.__module__].__doc__ or ""
    configurations: Sequence[type[Config]] = getattr(make, "configurations", ())
    own = describe(*configurations)
    return (
        f"{module.strip()}\n\n{(make.__doc__ or '').strip()}\n\n"
        "Set a parameter with --ros-args -p NAME:=VALUE, or several with --params-file FILE.\n\n"
        f"parameters of every node (default, range):\n{describe(NodeConfig)}\n\n"
        f"parameters of this node (default, range):\n{own}"
    )


def main(args: Sequence[str] | None = None) -> int:
    """Run the node of a registered name or of `my_package.my_module:MyNode`."""
    args = list(sys.argv[1:] if args is None else args)
    if not args or args[0].startswith("-"):
        choices = ", ".join(registry.names(registry.NODES))
        print(
            f"usage: python -m uvms_core.ros.main NODE [--ros-args ...]\nNODE is one of {choices},"
            " or a class as my_package.my_module:MyNode",
            file=sys.stderr,
        )
        return 2
    try:
        node = registry.load(registry.NODES, args[0])
    except UvmsError as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
    return main_of(node, args[1:])


if __name__ == "__main__":
    raise SystemExit(main())
