"""What `uvms view` does: opens the page, or writes a file."""

from __future__ import annotations

import webbrowser
from argparse import Namespace
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

from uvms_analysis.errors import determine
from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.log_source import LogSource

if TYPE_CHECKING:
    from uvms_bringup.viewer.live_page import LivePage
    from uvms_bringup.viewer.page import LogPage, Site


def show(options: Namespace) -> int:
    """Do what the options of `uvms view` say."""
    if options.live == (options.log is not None):
        raise ViewError("name a log, or --live for a running graph; one of the two")
    return _show_live(options) if options.live else _show_log(options)


def _show_live(options: Namespace) -> int:
    from uvms_bringup.ros.live_source import LiveSource
    from uvms_bringup.viewer.live_page import LivePage

    if options.export or options.picture or options.movie:
        raise ViewError("--export, --picture and --movie are of a log; --live has none yet")
    graph = LiveSource(options.vehicle, options.namespace)
    try:
        graph.wait()
        _serve(LivePage(graph, _site(options)), "live", options)
    finally:
        graph.close()
    return 0


def _site(options: Namespace) -> Site:
    from uvms_bringup.viewer.page import Site

    return Site(options.host, options.port, options.quality)


def _serve(page: LogPage | LivePage, name: str, options: Namespace) -> None:
    print(f"{name}: {page.address} (Ctrl-C ends it)", flush=True)
    if not options.no_browser:
        webbrowser.open(page.address)
    with suppress(KeyboardInterrupt):
        page.serve()


def _show_log(options: Namespace) -> int:
    """Each way imports what it needs: the page is there sooner."""
    source = determine(lambda: LogSource(options.log))
    if options.export is not None:
        from uvms_bringup.viewer.export import export

        print(export(source, options.export))
    elif options.picture is not None:
        print(_draw(source, options))
    elif options.movie is not None:
        from uvms_bringup.viewer.movie import write_movie

        span = _span(source, options)
        print(write_movie(source, options.movie, options.camera, span, options.speed))
    else:
        from uvms_bringup.viewer.page import LogPage

        _serve(LogPage(source, _site(options)), source.name, options)
    return 0


def _draw(source: LogSource, options: Namespace) -> Path:
    from uvms_bringup.viewer.picture import write_picture
    from uvms_bringup.viewer.scene_model import SceneModel

    time = source.end_s if options.at is None else options.at
    source.check_span(time, time)
    model, moment = SceneModel(source.setting), source.moment(time)
    return write_picture(model, moment, options.picture, options.camera, source.name)


def _span(source: LogSource, options: Namespace) -> tuple[float, float]:
    start = source.start_s if options.start is None else options.start
    end = source.end_s if options.end is None else options.end
    return start, end
