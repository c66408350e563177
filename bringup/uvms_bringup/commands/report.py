"""The command `uvms report`: a page about a run or about several, or a picture of one."""

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter
from pathlib import Path

from uvms_core.command import Command

DESCRIPTION = """\
Write a page about a run: did it work, how well, what disturbed it, what did it cost, how healthy
was it, was it stable; with plots to zoom into and the run in 3-D, in one file that needs no
network. Several runs come on one page, the same plots laid over one another."""
EPILOG = """examples:
  uvms report runs/on                          runs/on/report.html
  uvms report runs/on runs/off --output both   both/compare.html
  uvms report runs/on --picture vehicle.png    the 3-D picture alone"""
SEVERAL = "compare"
"""Folder of the page about several runs, where no other is named."""


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms report`."""
    parser.description, parser.epilog = DESCRIPTION, EPILOG
    parser.formatter_class = RawDescriptionHelpFormatter
    add = parser.add_argument
    add("logs", nargs="+", metavar="RUN.mcap|DIR", help="logs of runs, or their folders")
    add(
        "--output",
        metavar="DIR",
        help=f"where to (default: beside the log; of several runs: {SEVERAL})",
    )
    add("--no-3d", action="store_true", help="leave out the run in 3-D, some 3 MB of the page")
    add(
        "--picture",
        metavar="FILE",
        help="only draw the vehicle at work, in 3-D, to this file (png, jpg, pdf or svg)",
    )


def run(options: Namespace) -> int:
    """Write the page, or draw the picture; print where it is."""
    from uvms_analysis.errors import determine
    from uvms_analysis.log.locate import log_path
    from uvms_analysis.report import draw_scene, report
    from uvms_bringup.errors import ReportError

    if len(options.logs) > 1:
        if options.picture is not None:
            raise ReportError(f"--picture is of one run; {len(options.logs)} are given")
        return _several(options)
    log = log_path(options.logs[0])
    if options.picture is not None:
        print(determine(lambda: draw_scene(log, options.picture)))
    else:
        in_3d = None if options.no_3d else scene_of
        print(determine(lambda: report(log, options.output, in_3d)))
    return 0


def _several(options: Namespace) -> int:
    from uvms_analysis.compare import compare
    from uvms_analysis.errors import determine

    found = determine(lambda: compare(options.logs, options.output or SEVERAL))
    for warning in found.warnings:
        print(f"warning: {warning}")
    print(found.page)
    return 0


def scene_of(log: Path) -> str:
    """The page of a log in 3-D, as `uvms view --export` writes it.

    Raises:
        LogError: the log lacks vehicle or poses.
    """
    from tempfile import TemporaryDirectory

    from uvms_bringup.viewer.export import export
    from uvms_bringup.viewer.log_source import LogSource

    with TemporaryDirectory() as folder:
        return export(LogSource(log), Path(folder) / "scene.html").read_text(encoding="utf-8")


COMMAND = Command(
    "a page about a run or several, with plots and 3-D; a picture", add_arguments, run
)
