"""What `uvms validate` and `uvms identify` have in common: trials, vehicle, and progress."""

import sys
from argparse import ArgumentParser


def add_trial_arguments(parser: ArgumentParser) -> None:
    """The folder of the trials and the vehicle that made them."""
    from uvms_core.vehicle.locate import known_vehicles

    parser.add_argument(
        "trials",
        metavar="TRIALS_DIR",
        help="folder with one CSV a trial, as bringup/data/pool_trials (its README has the"
        " columns)",
    )
    parser.add_argument(
        "--vehicle",
        metavar="VEHICLE",
        required=True,
        help=f"one of {', '.join(known_vehicles())}, or a YAML file",
    )


def print_progress(line: str) -> None:
    """One line on stderr, so that stdout holds the result alone."""
    print(line, file=sys.stderr, flush=True)
