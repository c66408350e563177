"""The command `uvms vehicle`: is a vehicle file right, and what is the vehicle like?"""

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter

from uvms_core.command import Command

DESCRIPTION = """\
Check a vehicle file and print what the vehicle is like: masses and buoyancy, how it floats in each
posture, what its thrusters reach, its natural periods and speeds, the load of its joints."""
EPILOG = """examples:
  uvms vehicle my_auv.yaml
  uvms vehicle bluerov2_alpha5 --set hull.cb_m=[0,0,-0.03]
  uvms vehicle my_auv.yaml --json | jq .warnings

Errors are what no vehicle can be, and the file is refused; warnings are odd, and may be meant;
notes are what was taken for the rounding of a printed table. Exit code: 0, or 2 with errors."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms vehicle`."""
    parser.description, parser.epilog = DESCRIPTION, EPILOG
    parser.formatter_class = RawDescriptionHelpFormatter
    add = parser.add_argument
    add("vehicle", metavar="FILE", help="vehicle file, or the name of one of the project's")
    add(
        "--set",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="change a value of the vehicle file (hull.mass_kg=190); may be repeated",
    )
    add("--json", action="store_true", help="print data for scripts")


def run(options: Namespace) -> int:
    """Print errors, warnings, notes and the summary; 2 if there are errors."""
    from uvms_bringup.vehicle_page import show_vehicle

    return show_vehicle(options.vehicle, options.set, options.json)


COMMAND = Command("check a vehicle file and say what the vehicle is like", add_arguments, run)
