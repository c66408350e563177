"""A command of `uvms`: what an entry point of the group `uvms.commands` names.

The module of an entry is imported for its line in `uvms --help`, so it imports nothing heavy at
its top; what a command needs for its options or its work it imports inside the functions.
"""

from argparse import ArgumentParser, Namespace
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Command:
    """One command; the name of its entry point is the word that the user types."""

    help: str
    """One line for `uvms --help`, without a full stop."""
    add_arguments: Callable[[ArgumentParser], None]
    """Adds positional arguments and options; may set the parser's `description` and `epilog`."""
    run: Callable[[Namespace], int]
    """Does the work and returns the exit code. `options.command_line` is what the user typed.

    An error of the project's own tree (`uvms_core.errors.UvmsError`) ends in one line and code 2.
    """
