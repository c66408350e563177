"""The command `uvms`: assembles the commands that the installed packages bring.

A command is an entry point of the group `uvms.commands` (`uvms_core.command.Command`).
"""

import argparse
import os
import shlex
import sys
from collections.abc import Sequence
from importlib.metadata import version
from typing import Any

from uvms_bringup.errors import BringupError
from uvms_core import registry
from uvms_core.command import Command
from uvms_core.errors import PluginError, UvmsError

EXAMPLES = """examples:
  uvms run manipulation                        the 900 s manipulation on six ROS 2 nodes
  uvms run arm_swing --set control.observer=false --output runs/without_observer
  uvms simulate hover --seed 3 --duration 20   the same loop in one process, without ROS
  uvms report runs/without_observer/run.mcap   a page about a run, with plots and 3-D
  uvms campaign observer_study                 many runs on all cores, judged by requirements
  uvms compare runs/one runs/two               two runs side by side
  uvms replay runs/without_observer/run.mcap --into controller
  uvms added-mass spheroid:2.4,0.38            added mass of a shape or of a mesh file
  uvms validate bringup/data/pool_trials --vehicle bluerov2_alpha5
"""
FIRST = ("run", "simulate", "replay", "report")
"""Listed first in the help, in the order of their use; the others follow by name."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; the project's own errors end in one clear message and code 2."""
    arguments = list(sys.argv[1:] if arguments is None else arguments)
    try:
        _search_working_directory()
        options = parser(_chosen(arguments)).parse_args(arguments)
        options.command_line = "uvms " + _readable(shlex.join(arguments))
        return options.run_command(options)
    except BrokenPipeError:  # the reader of the output has gone, as in `uvms fields | head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141
    except (UvmsError, OSError) as fault:  # OSError: the disk is full, a folder may not be written
        print(f"error: {fault}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("interrupted", file=sys.stderr)
        return 130


def _readable(text: str) -> str:
    """Text of the command line for UTF-8 files, whatever encoding the terminal has."""
    return os.fsencode(text).decode("utf-8", errors="backslashreplace")


def _search_working_directory() -> None:
    """Find `my_module:MyClass` in the working directory, as `python -m` does for the nodes."""
    try:
        here = os.getcwd()
    except FileNotFoundError:
        raise BringupError(
            "the working directory does not exist any more; change to another one"
        ) from None
    if here not in sys.path:
        sys.path.append(here)


def parser(chosen: str | None = None) -> argparse.ArgumentParser:
    """The parser of one command, or the one that lists them all.

    Only the chosen command is imported, so that no command waits for the imports of the others.

    Raises:
        PluginError: the chosen command cannot be imported.
    """
    top = argparse.ArgumentParser(
        prog="uvms",
        description="An underwater vehicle with an arm: run it, simulate it, work on its logs.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    top.add_argument("--version", action="version", version=f"uvms {version('uvms_bringup')}")
    commands = top.add_subparsers(required=True, metavar="COMMAND")
    if chosen is not None:
        _add(commands, chosen, registry.load(registry.COMMANDS, chosen))
        return top
    for name in _listed():
        commands.add_parser(name, help=_help(name))
    return top


def _chosen(arguments: Sequence[str]) -> str | None:
    """The command that the arguments begin with, if there is one of that name."""
    word = arguments[0] if arguments else ""
    return word if word in registry.names(registry.COMMANDS) else None


def _listed() -> list[str]:
    names = registry.names(registry.COMMANDS)
    return sorted(
        names, key=lambda name: (FIRST.index(name) if name in FIRST else len(FIRST), name)
    )


def _help(name: str) -> str:
    """A command that cannot be imported says so in its line, and does not spoil the others."""
    try:
        return registry.load(registry.COMMANDS, name).help
    except PluginError as fault:
        return f"(not available: {fault})"


def _add(commands: Any, name: str, command: Command) -> None:
    text = command.help
    own = commands.add_parser(name, help=text, description=f"{text[0].upper()}{text[1:]}.")
    own.set_defaults(run_command=command.run)
    command.add_arguments(own)


if __name__ == "__main__":
    raise SystemExit(main())
