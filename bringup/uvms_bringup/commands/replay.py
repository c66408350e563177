"""The command `uvms replay`: a log published again, or fed into one node."""

from argparse import ArgumentParser, Namespace

from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms replay`."""
    from uvms_core import topics

    add = parser.add_argument
    add("log", metavar="RUN.mcap", help="log of a run")
    add(
        "--into",
        metavar="NODE",
        help="start this node, feed it and compare what it answers with the log: "
        + ", ".join(topics.NODES),
    )
    add(
        "--rate",
        type=float,
        default=None,
        metavar="FACTOR",
        help="speed against real time (default 1; with --into as fast as the node answers)",
    )
    add("--output", metavar="DIR", help="folder for what --into records (default: beside the log)")


def run(options: Namespace) -> int:
    """Replay the log; 1 if a node left ticks unanswered."""
    from uvms_bringup.ros.replay import replay

    return replay(options.log, into=options.into, rate=options.rate, output=options.output)


COMMAND = Command(
    "publish a log again with /clock, or feed one node with its recorded inputs",
    add_arguments,
    run,
)
