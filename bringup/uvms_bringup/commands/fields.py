"""The command `uvms fields`: every field of a vehicle file and of a scenario."""

from argparse import ArgumentParser, Namespace

from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms fields`."""
    parser.add_argument(
        "--output", metavar="DIR", help="write fields-vehicle.md and fields-scenario.md to a folder"
    )


def run(options: Namespace) -> int:
    """Print the two pages, or write them to a folder."""
    from uvms_bringup.fields import write_pages

    return write_pages(options.output)


COMMAND = Command("list every field of a vehicle file and of a scenario", add_arguments, run)
