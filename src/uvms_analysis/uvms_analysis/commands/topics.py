"""The command `uvms topics`: every topic of the system, or the values of some in a log."""

from argparse import ArgumentParser, Namespace

from uvms_core.command import Command

DESCRIPTION = """Without a log: every topic of the system, its type, its frame, and which node
writes and reads it. With a log: the least, mean, greatest and last value of every number in the
messages of the topics named (see `uvms info` for those that a log has)."""
EPILOG = """examples:
  uvms topics                                       what the nodes exchange
  uvms topics --vehicle my_vehicle.yaml             and with the sensors of my vehicle
  uvms topics runs/hover/run.mcap odometry wrench_command
"""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms topics`."""
    from argparse import RawDescriptionHelpFormatter

    parser.description, parser.epilog = DESCRIPTION, EPILOG
    parser.formatter_class = RawDescriptionHelpFormatter
    parser.add_argument("log", nargs="?", metavar="RUN.mcap|DIR", help="log, or folder with one")
    parser.add_argument("topics", nargs="*", metavar="TOPIC", help="topics of the log")
    parser.add_argument(
        "--vehicle", default="reference_auv", help="vehicle whose sensors are listed (%(default)s)"
    )


def run(options: Namespace) -> int:
    """Print the table of the system, or that of each topic."""
    print(_system(options.vehicle) if options.log is None else _values(options))
    return 0


def _system(name: str) -> str:
    from uvms_analysis.overview.graph_rows import graph_text
    from uvms_core.vehicle import load_vehicle

    return graph_text(load_vehicle(name))


def _values(options: Namespace) -> str:
    from uvms_analysis.errors import LogError
    from uvms_analysis.log.locate import log_path
    from uvms_analysis.log.read import RunLog
    from uvms_analysis.overview import value_rows, values_text

    log = RunLog.open(log_path(options.log))
    if not options.topics:
        raise LogError(f"name the topics; log {log.path} has {', '.join(sorted(log.topics))}")
    parts = [f"{topic}\n{values_text(value_rows(log, topic))}" for topic in options.topics]
    return "\n\n".join(parts)


COMMAND = Command("every topic of the system, or values of topics in a log", add_arguments, run)
