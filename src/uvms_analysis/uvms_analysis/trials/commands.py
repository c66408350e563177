"""The commands `uvms validate` and `uvms identify`."""

import argparse
import sys
from typing import Any

from uvms_core.vehicle.locate import known_vehicles, vehicle_path

VALIDATE = """Drive the full dynamic model of the vehicle with the measured joint motion of recorded
trials, from the measured initial state, and compare its roll and pitch with the measured ones."""

IDENTIFY = """Fit the constants of the vehicle file that the trials determine, print each with its
standard error, and write the file with the fitted values; the others stay as they are."""

_FOLDER = "folder with one CSV a trial, as bringup/data/pool_trials (its README has the columns)"


def add_commands(commands: Any) -> None:
    """Add both to the command line."""
    add = _command(
        commands,
        "validate",
        validate,
        "predict recorded trials, and compare",
        VALIDATE,
    )
    add("--output", metavar="DIR", help="write TRIAL.csv (t,roll,pitch; degrees) and table.txt")
    add("--figures", action="store_true", help="draw the trials into the folder of --output")
    add("--no-trim", action="store_true", help="without the trim that the first tilt shows")
    add = _command(
        commands,
        "identify",
        identify,
        "fit what recorded trials determine",
        IDENTIFY,
    )
    add(
        "--output",
        metavar="FILE",
        required=True,
        help="vehicle file to write, not that of --vehicle",
    )
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
    command.add_argument(
        "--vehicle",
        metavar="VEHICLE",
        required=True,
        help=f"one of {', '.join(known_vehicles())}, or a YAML file",
    )
    return command.add_argument


def validate(options: argparse.Namespace) -> int:
    """`uvms validate`."""
    from uvms_analysis.errors import TrialError
    from uvms_analysis.trials.validate import validate as run

    if options.figures and options.output is None:
        raise TrialError("--figures needs --output DIR, the folder to draw them into")
    vehicle = str(vehicle_path(options.vehicle))
    trim = not options.no_trim
    print(run(options.trials, vehicle, options.output, options.figures, _tell, trim))
    return 0


def identify(options: argparse.Namespace) -> int:
    """`uvms identify`."""
    from uvms_analysis.trials.cross_validate import cross_validated
    from uvms_analysis.trials.identify import check_output, identify_file, report, write

    vehicle = str(vehicle_path(options.vehicle))
    check_output(vehicle, options.output)
    found, courses = identify_file(options.trials, vehicle, _tell)
    print(report(found))
    print(f"written: {write(found, vehicle, options.output)}", flush=True)
    if options.cross_validate:
        print(cross_validated(found, courses, _tell))
    return 0


def _tell(line: str) -> None:
    print(line, file=sys.stderr, flush=True)
