"""The command `uvms run`: a scenario on the ROS 2 node graph."""

from argparse import ArgumentParser, Namespace
from typing import Any

from uvms_bringup.commands.scenario_options import (
    add_scenario_options,
    conclude,
    open_session,
)
from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms run`."""
    add_scenario_options(parser)
    parser.add_argument(
        "--respawn",
        action="store_true",
        help="with --pace realtime: start a node that dies again, the plant apart",
    )


def run(options: Namespace) -> int:
    """Run the scenario on the graph; the exit code tells the outcome."""
    from uvms_bringup.pace import Pace

    pace = Pace.parse(options.pace)
    if options.respawn:
        _check_respawn(options, pace.name)
    session = open_session(options, pace)

    def work() -> dict[str, Any]:
        return session.run_graph(pace, options.composed, options.respawn)

    return conclude(session, work, options.json)


def _check_respawn(options: Namespace, pace: str) -> None:
    from uvms_bringup.errors import RunError

    if pace != "realtime" or options.composed:
        raise RunError(
            "--respawn: needs --pace realtime and nodes in processes of their own; in lockstep a"
            " node that dies takes its part of the run with it, and the run ends"
        )


COMMAND = Command("run a scenario on the ROS 2 node graph, recorded to MCAP", add_arguments, run)
