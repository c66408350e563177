"""What `uvms view` does: opens the page, or writes a file."""

import webbrowser
from argparse import Namespace
from contextlib import suppress

from uvms_analysis.errors import determine
from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.export import export
from uvms_bringup.viewer.live_page import LivePage
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.movie import write_movie
from uvms_bringup.viewer.page import LogPage
from uvms_bringup.viewer.picture import write_picture
from uvms_bringup.viewer.scene_model import SceneModel


def show(options: Namespace) -> int:
    """Do what the options of `uvms view` say."""
    if options.live == (options.log is not None):
        raise ViewError("name a log, or --live for a running graph; one of the two")
    return _show_live(options) if options.live else _show_log(options)


def _show_live(options: Namespace) -> int:
    from uvms_bringup.ros.live_source import LiveSource

    if options.export or options.picture or options.movie:
        raise ViewError("--export, --picture and --movie are of a log; --live has none yet")
    graph = LiveSource(options.vehicle, options.namespace)
    try:
        graph.wait()
        _serve(LivePage(graph, options.host, options.port), "live", options)
    finally:
        graph.close()
    return 0


def _serve(page: LogPage | LivePage, name: str, options: Namespace) -> None:
    print(f"{name}: {page.address} (Ctrl-C ends it)", flush=True)
    if not options.no_browser:
        webbrowser.open(page.address)
    with suppress(KeyboardInterrupt):
        page.serve()


def _show_log(options: Namespace) -> int:
    source = determine(lambda: LogSource(options.log))
    if options.export is not None:
        print(export(source, options.export))
        return 0
    if options.picture is not None:
        time = source.end_s if options.at is None else options.at
        source.check_span(time, time)
        moment = source.moment(time)
        model = SceneModel(source.setting)
        print(write_picture(model, moment, options.picture, options.camera, source.name))
        return 0
    if options.movie is not None:
        print(
            write_movie(
                source, options.movie, options.camera, _span(source, options), options.speed
            )
        )
        return 0
    _serve(LogPage(source, options.host, options.port), source.name, options)
    return 0


def _span(source: LogSource, options: Namespace) -> tuple[float, float]:
    start = source.start_s if options.start is None else options.start
    end = source.end_s if options.end is None else options.end
    return start, end
