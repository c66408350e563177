"""The command `uvms run`: a scenario on the ROS 2 node graph."""

from argparse import ArgumentParser, Namespace

from uvms_bringup.commands.scenario_options import (
    add_scenario_options,
    open_session,
    print_summary,
)
from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms run`."""
    add_scenario_options(parser)


def run(options: Namespace) -> int:
    """Run the scenario on the graph; 1 if it did not complete."""
    from uvms_bringup.pace import Pace

    pace = Pace.parse(options.pace)
    session = open_session(options, pace)
    return print_summary(session, session.run_graph(pace, options.composed))


COMMAND = Command("run a scenario on the ROS 2 node graph, recorded to MCAP", add_arguments, run)
