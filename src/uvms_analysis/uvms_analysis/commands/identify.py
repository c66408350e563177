"""The command `uvms identify`: constants of the vehicle file, fitted to recorded trials."""

from argparse import ArgumentParser, Namespace

from uvms_analysis.commands.trial_options import add_trial_arguments, print_progress
from uvms_core.command import Command

DESCRIPTION = """Fit the constants of the vehicle file that the trials determine, print each with
its standard error, and write the file with the fitted values; the others stay as they are."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms identify`."""
    parser.description = DESCRIPTION
    add_trial_arguments(parser)
    parser.add_argument(
        "--output",
        metavar="FILE",
        required=True,
        help="vehicle file to write, not that of --vehicle",
    )
    parser.add_argument(
        "--cross-validate",
        action="store_true",
        help="also fit without each trial, and without each motion, and score what was left out"
        " (some minutes)",
    )


def run(options: Namespace) -> int:
    """Fit, print the constants and write the vehicle file."""
    from uvms_analysis.trials.cross_validate import cross_validated
    from uvms_analysis.trials.identify import check_output, identify_file, report, write
    from uvms_core.vehicle.locate import vehicle_path

    vehicle = str(vehicle_path(options.vehicle))
    check_output(vehicle, options.output)
    found, prepared = identify_file(options.trials, vehicle, print_progress)
    print(report(found))
    print(f"written: {write(found, vehicle, options.output)}", flush=True)
    if options.cross_validate:
        print(cross_validated(found, prepared, print_progress))
    return 0


COMMAND = Command("fit what recorded trials determine", add_arguments, run)
