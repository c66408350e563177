"""The command `uvms report`: figures and a page about a run."""

from argparse import ArgumentParser, Namespace

from uvms_core.command import Command


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms report`."""
    parser.add_argument("log", metavar="RUN.mcap|DIR", help="log of a run, or its folder")
    parser.add_argument("--output", metavar="DIR", help="where to (default: beside the log)")
    parser.add_argument(
        "--picture",
        metavar="FILE",
        help="only draw the vehicle at work, in 3-D, to this file (png, jpg, pdf or svg)",
    )


def run(options: Namespace) -> int:
    """Draw the figures and write the page, or draw the picture; print where it is."""
    from uvms_analysis.errors import determine
    from uvms_analysis.log.locate import log_path
    from uvms_analysis.report import draw_scene, report

    log = log_path(options.log)
    if options.picture is not None:
        print(determine(lambda: draw_scene(log, options.picture)))
    else:
        print(determine(lambda: report(log, options.output)))
    return 0


COMMAND = Command("figures and an HTML page about a run, or a 3-D picture", add_arguments, run)
