"""The command `uvms check`: whether a log is complete."""

import json
from argparse import ArgumentParser, Namespace

from uvms_core.command import Command

DESCRIPTION = """Verify a log of any origin: checksums, structure and index; messages expected and
received on each topic; order, gaps and doubled messages; the span against what was asked for;
commands that came late or were never used; who else took part. Exit code 0: complete, 1: not
complete, 2: not a log."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms check`."""
    parser.description = DESCRIPTION
    parser.add_argument("log", metavar="RUN.mcap|DIR", help="log, or folder with one in it")
    parser.add_argument("--json", action="store_true", help="everything as JSON")


def run(options: Namespace) -> int:
    """Check, print, and answer by the exit code."""
    from uvms_analysis.check import check_log
    from uvms_analysis.check.text import as_text
    from uvms_analysis.log.locate import log_path

    check = check_log(log_path(options.log))
    print(json.dumps(check.to_json(), indent=2) if options.json else as_text(check))
    return 0 if check.complete else 1


COMMAND = Command("whether a log is complete and undamaged", add_arguments, run)
