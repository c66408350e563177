"""The command `uvms simulate`: a scenario in one process without ROS."""

import sys
from argparse import ArgumentParser, Namespace
from typing import Any

from uvms_bringup.commands.scenario_options import (
    add_scenario_options,
    conclude,
    introduce,
    open_session,
)
from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms simulate`: those of `uvms run`, some without effect."""
    add_scenario_options(parser, note=" (for `uvms run`)", optional=True)
    parser.add_argument(
        "--again",
        nargs=3,
        metavar=("DIR", "CASE", "SEED"),
        help="in the place of a scenario: make this row of the campaign in DIR again, with its log",
    )


def run(options: Namespace) -> int:
    """Run the scenario in this process; the exit code tells the outcome."""
    from uvms_bringup.errors import RunError
    from uvms_bringup.pace import Pace

    _refuse_nodes(options)
    lockstep = Pace()
    _note_unused(options, Pace.parse(options.pace) != lockstep)
    if options.again:
        return _again(options)
    if options.scenario is None:
        raise RunError("name a scenario, or a row of a campaign by --again DIR CASE SEED")
    session = open_session(options, lockstep)
    return conclude(session, session.run_simulation, options.json)


def _again(options: Namespace) -> int:
    """Make a row of a campaign again, and say whether it came out the same."""
    from pathlib import Path

    from uvms_bringup.campaign.again import Again
    from uvms_bringup.errors import RunError

    folder, case, seed = options.again
    own = (options.scenario, options.seed, options.duration, options.vehicle, options.set or None)
    if any(one is not None for one in own):
        raise RunError(
            "--again makes a row as it was: leave out SCENARIO, --seed, --duration,"
            " --vehicle and --set"
        )
    if not seed.isdigit():
        raise RunError(f"--again: the seed {seed!r} is not a whole number")
    again = Again.of(Path(folder).resolve(), case, int(seed))
    session = again.session(options.output, options.command_line)
    introduce(session, options.json)
    made: dict[str, Any] = {}

    def work() -> dict[str, Any]:
        made.update(session.run_simulation())
        return made

    code = conclude(session, work, options.json)
    if made:
        _compare(again.differences(made), again.row is not None)
    return code


def _compare(differences: list[str], is_there: bool) -> None:
    if not is_there:
        text = "note: the campaign has not made this run yet"
    elif not differences:
        text = "the same as the row of the campaign in every field but its timings"
    else:
        text = "warning: not the same as the row of the campaign:\n  " + "\n  ".join(differences)
    print(text, file=sys.stderr)


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
