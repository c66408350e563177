"""The command `uvms validate`: recorded trials predicted by the model."""

from argparse import ArgumentParser, Namespace

from uvms_analysis.commands.trial_options import add_trial_arguments, print_progress
from uvms_core.command import Command

DESCRIPTION = """Drive the full dynamic model of the vehicle with the measured joint motion of
recorded trials, from the measured initial state, and compare its roll and pitch with the measured
ones."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms validate`."""
    parser.description = DESCRIPTION
    add_trial_arguments(parser)
    add = parser.add_argument
    add("--output", metavar="DIR", help="write TRIAL.csv (t,roll,pitch; degrees) and table.txt")
    add("--figures", action="store_true", help="draw the trials into the folder of --output")
    add("--no-trim", action="store_true", help="without the trim that the first tilt shows")


def run(options: Namespace) -> int:
    """Predict the trials and print the table of errors."""
    from uvms_analysis.errors import TrialError
    from uvms_analysis.trials.validate import validate
    from uvms_core.vehicle.locate import vehicle_path

    if options.figures and options.output is None:
        raise TrialError("--figures needs --output DIR, the folder to draw them into")
    vehicle = str(vehicle_path(options.vehicle))
    trim = not options.no_trim
    print(validate(options.trials, vehicle, options.output, options.figures, print_progress, trim))
    return 0


COMMAND = Command("predict recorded trials, and compare", add_arguments, run)
