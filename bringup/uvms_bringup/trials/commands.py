"""The commands `uvms validate` and `uvms identify`."""

import argparse
import sys
from typing import Any

VALIDATE = """Drive the full dynamic model of the vehicle with the measured joint motion of recorded
trials, from the measured initial state, and compare its roll and pitch with the measured ones."""

IDENTIFY = """Fit the constants of the vehicle file that the trials determine, print each with its
standard error, and write the file with the fitted values; the others stay as they are."""

_FOLDER = "folder with one CSV a trial, as bringup/data/pool_trials (its README has the columns)"


def add_commands(commands: Any) -> None:
    """Add both to the command line."""
    add = _command(commands, "validate", validate, "hold the model against trials", VALIDATE)
    add("--output", metavar="DIR", help="write TRIAL.csv (t,roll,pitch; degrees) and table.txt")
    add("--figures", action="store_true", help="draw the trials into the folder of --output")
    add = _command(commands, "identify", identify, "fit constants to trials", IDENTIFY)
    add("--output", metavar="FILE", required=True, help="vehicle file to write")
    add(
        "--cross-validate",
        action="store_true",
        help="also fit without each trial, and without each motion, and score what was left out"
        " (some minutes)",
    )


def _command(commands: Any, name: str, action: Any, text: str, description: str) -> Any:
    command = commands.add_parser(name, help=text, description=description)
    command.set_defaults(do=action)
    command.add_argument("trials", metavar="TRIALS_DIR", help=_FOLDER)
    command.add_argument("--vehicle", metavar="FILE", required=True, help="vehicle file")
    return command.add_argument


def validate(options: argparse.Namespace) -> int:
    """`uvms validate`."""
    from uvms_bringup.errors import TrialError
    from uvms_bringup.trials.validate import validate as run

    if options.figures and options.output is None:
        raise TrialError("--figures needs --output DIR, the folder to draw them into")
    print(run(options.trials, options.vehicle, options.output, options.figures))
    return 0


def identify(options: argparse.Namespace) -> int:
    """`uvms identify`."""
    from uvms_bringup.trials.cross_validate import cross_validated
    from uvms_bringup.trials.identify import identify_file, report, write

    found, courses = identify_file(options.trials, options.vehicle, _tell)
    print(report(found))
    print(f"written: {write(found, options.vehicle, options.output)}", flush=True)
    if options.cross_validate:
        print(cross_validated(found, courses, _tell))
    return 0


def _tell(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
