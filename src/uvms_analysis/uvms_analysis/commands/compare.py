"""The command `uvms compare`: runs side by side."""

from argparse import ArgumentParser, Namespace

from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms compare`."""
    parser.add_argument("runs", nargs="+", metavar="RUN", help="folder or log of a run")
    parser.add_argument(
        "--output",
        default="compare",
        metavar="DIR",
        help="folder of the page (default: compare)",
    )


def run(options: Namespace) -> int:
    """Print the fields that differ, and where the page with the plots is."""
    from shutil import get_terminal_size

    from uvms_analysis.compare import compare
    from uvms_analysis.compare.table import as_text
    from uvms_analysis.errors import determine

    found = determine(lambda: compare(options.runs, options.output))
    for warning in found.warnings:
        print(f"warning: {warning}")
    print(as_text(found.names, found.rows, get_terminal_size().columns))
    print(f"page: {found.page}")
    return 0


COMMAND = Command("runs side by side: a table of what differs, and a page", add_arguments, run)
