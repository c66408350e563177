"""The command `uvms view`: a run in 3-D, in the browser, as a file to share, picture or movie."""

from argparse import ArgumentParser, Namespace, RawDescriptionHelpFormatter

from uvms_core.command import Command

DESCRIPTION = """\
Look at a run in 3-D. Without an option a page opens in the browser: hull and arm as the filter
sees them (solid) and as they are (ghost), thrusts, disturbances, the tool's path and target, with
a time line, plots and cameras. --export, --picture and --movie write a file instead; they need no
browser."""
EPILOG = """examples:
  uvms view runs/manipulation                       the page, until Ctrl-C
  uvms view runs/manipulation --export run.html     one file to send to somebody, works offline
  uvms view runs/manipulation --picture at.png --at 450
  uvms view runs/manipulation --movie run.gif --from 300 --to 360 --speed 5
  uvms view --live                                  a graph that `uvms run` has started

Colours: solid is the estimate, the ghost the truth; the red ball is port, the green one starboard;
thrust arrows go from green to red at their limit."""

CAMERAS = ("wide", "bow", "chase", "tool", "top")


def add_arguments(parser: ArgumentParser) -> None:
    """Options of `uvms view`."""
    parser.description, parser.epilog = DESCRIPTION, EPILOG
    parser.formatter_class = RawDescriptionHelpFormatter
    add = parser.add_argument
    add("log", nargs="?", metavar="RUN.mcap|DIR", help="log of a run, or its folder")
    add("--live", action="store_true", help="follow a running graph, send goals, lead the tool")
    add("--vehicle", metavar="FILE", help="with --live: its vehicle (default: as its planner says)")
    add("--namespace", default="", metavar="NAME", help="with --live: of the vehicle's topics")
    out = parser.add_mutually_exclusive_group()
    out.add_argument("--export", metavar="FILE.html", help="write a page that needs no server")
    out.add_argument("--picture", metavar="FILE.png", help="write a picture")
    out.add_argument("--movie", metavar="FILE.gif|mp4", help="write a movie")
    add("--at", type=float, metavar="S", help="time of the picture, s (default: the end)")
    add("--from", dest="start", type=float, metavar="S", help="where the movie begins, s")
    add("--to", dest="end", type=float, metavar="S", help="where it ends, s")
    add(
        "--speed",
        type=float,
        metavar="FACTOR",
        help="of the movie against real time (default: so that it takes 10 s)",
    )
    add("--camera", choices=CAMERAS, default="wide", help="of picture and movie (default: wide)")
    add("--host", default="127.0.0.1", help="address of the page (default: this machine alone)")
    add("--port", type=int, default=8080, help="port of the page (default 8080; the next free one)")
    add(
        "--quality",
        choices=("auto", "high", "low"),
        default="auto",
        help="of the page; low: no smooth edges, faster (default: low where a processor draws)",
    )
    add("--no-browser", action="store_true", help="print the address, open no browser")


def run(options: Namespace) -> int:
    """Show the run until it is interrupted, or write the file that was asked for."""
    from uvms_bringup.viewer.show import show

    return show(options)


COMMAND = Command(
    "look at a run in 3-D: a page, a file to share, a picture, a movie", add_arguments, run
)
