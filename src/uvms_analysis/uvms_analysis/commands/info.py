"""The command `uvms info`: what a log is and has."""

import json
from argparse import ArgumentParser, Namespace

from uvms_core.command import Command

DESCRIPTION = """A quick look at a log of any origin: its size and time, the run that it is of, how
that ended, and every topic with its rate and longest gap. It judges nothing: see `uvms check`."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms info`."""
    parser.description = DESCRIPTION
    parser.add_argument("log", metavar="RUN.mcap|DIR", help="log, or folder with one in it")
    parser.add_argument("--json", action="store_true", help="everything as JSON")


def run(options: Namespace) -> int:
    """Read and print."""
    from dataclasses import asdict

    from uvms_analysis.log.locate import log_path
    from uvms_analysis.log.read import RunLog
    from uvms_analysis.overview import info_text, log_info, topic_rows

    log = RunLog.open(log_path(options.log))
    rows = topic_rows(log)
    facts = log_info(log, rows)
    if options.json:
        print(json.dumps(facts | {"topics": list(map(asdict, rows))}, indent=2))
    else:
        print(info_text(log, facts, rows))
    return 0


COMMAND = Command("what a log is: its run, its time, its topics and rates", add_arguments, run)
