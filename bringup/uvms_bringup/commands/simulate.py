"""The command `uvms simulate`: a scenario in one process without ROS."""

import sys
from argparse import ArgumentParser, Namespace

from uvms_bringup.commands.scenario_options import (
    add_scenario_options,
    conclude,
    open_session,
)
from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms simulate`: those of `uvms run`, some without effect."""
    add_scenario_options(parser, note=" (for `uvms run`)")


def run(options: Namespace) -> int:
    """Run the scenario in this process; the exit code tells the outcome."""
    from uvms_bringup.pace import Pace

    _refuse_nodes(options)
    lockstep = Pace()
    _note_unused(options, Pace.parse(options.pace) != lockstep)
    session = open_session(options, lockstep)
    return conclude(session, session.run_simulation, options.json)


def _refuse_nodes(options: Namespace) -> None:
    from uvms_bringup.errors import RunError

    for option, given in (("--node", options.node), ("--without", options.without)):
        if given:
            raise RunError(
                f"{option} {given[0]}: `uvms simulate` has no nodes; put a class of yours into the"
                " loop with --set control.law=my_package.my_law:MyLaw (observer.law,"
                " planner.method, allocation.method, navigation.filter), or use `uvms run`"
            )


def _note_unused(options: Namespace, paced: bool) -> None:
    given = {f"--pace {options.pace}": paced, "--composed": options.composed}
    if unused := [name for name, is_given in given.items() if is_given]:
        print(
            f"note: {' and '.join(unused)}: no effect on `uvms simulate`, which always runs in one"
            " process, as fast as the machine; `uvms run` uses it",
            file=sys.stderr,
        )


COMMAND = Command("run a scenario in one process without ROS, logged alike", add_arguments, run)
