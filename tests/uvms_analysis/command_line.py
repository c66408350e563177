"""Runs a registered command as `uvms` does, without the package that has the command line."""

import argparse
import sys

from uvms_core import registry
from uvms_core.errors import UvmsError


def main(arguments):
    """Exit code of a command; an error of the project is one line on stderr and code 2."""
    name, *words = arguments
    command = registry.load(registry.COMMANDS, name)
    parser = argparse.ArgumentParser(prog=name)
    command.add_arguments(parser)
    try:
        return command.run(parser.parse_args(words))
    except UvmsError as fault:
        print(f"error: {fault}", file=sys.stderr)
        return 2
