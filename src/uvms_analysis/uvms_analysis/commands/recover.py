"""The command `uvms recover`: a complete, indexed log from one that broke off."""

from argparse import ArgumentParser, Namespace

from uvms_core.command import Command

DESCRIPTION = """Copy everything that is whole in a log whose writer was killed, or that is damaged,
into a new file that every tool opens. The times of the messages stay as they are."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms recover`."""
    parser.description = DESCRIPTION
    parser.add_argument("log", metavar="BROKEN.mcap|DIR", help="log, or folder with one in it")
    parser.add_argument("output", metavar="OUT.mcap", help="file to write; it must not exist")


def run(options: Namespace) -> int:
    """Recover, and say how much was kept and lost."""
    from uvms_analysis.log.locate import log_path
    from uvms_analysis.log.recover import recover

    print(recover(log_path(options.log), options.output))
    return 0


COMMAND = Command("a complete log from one that broke off", add_arguments, run)
