"""viser's page with what we add: plots under its view, and a quality that the computer can draw.

Without a graphics card most of the time of a frame goes into smooth edges. viser asks for them
whatever draws, so the page declines them where a processor does, or where the user says so.
"""

from collections.abc import Sequence
from contextlib import redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import viser
from viser import infra

from uvms_bringup.viewer.overview import Plot
from uvms_bringup.viewer.plot_strip import plot_strip
from uvms_core.signals import Array

NO_TIMES = np.empty(0)
AUTO, HIGH, LOW = QUALITIES = "auto", "high", "low"
"""`low` has no smooth edges; `auto` is `low` where a processor draws, else `high`."""
SCRIPT = """
(() => {
  const renderer = () => {
    const gl = document.createElement('canvas').getContext('webgl2');
    const told = gl?.getExtension('WEBGL_debug_renderer_info');
    const name = told ? gl.getParameter(told.UNMASKED_RENDERER_WEBGL) : '';
    gl?.getExtension('WEBGL_lose_context')?.loseContext();
    return name;
  };
  const asked = new URLSearchParams(location.search).get('quality');
  const isLow = asked === 'low' || (
    asked !== 'high' && /swiftshader|llvmpipe|softpipe|software/i.test(renderer()));
  document.documentElement.dataset.quality = isLow ? 'low' : 'high';
  if (isLow) {
    const get = HTMLCanvasElement.prototype.getContext;
    HTMLCanvasElement.prototype.getContext = function (kind, options) {
      return get.call(this, kind, options && {...options, antialias: false});
    };
  }
  const hide = () => {  // viser draws a plane over the whole view even where there is no picture
    const background = window.__viserMutable?.backgroundMaterial;
    if (background) background.visible = false; else setTimeout(hide, 100);
  };
  hide();
})();
"""
STYLE = """
[data-quality=low] .quality-low, [data-quality=high] .quality-high { font-weight: bold; }
"""
CHOICE = (
    '<div style="padding: 0 0.8em; font-size: 0.85em">Smooth edges: '
    '<a class="quality-high" href="?quality=high">on</a> · '
    '<a class="quality-low" href="?quality=low">off, faster</a> · '
    '<a href="?quality=auto">automatic</a></div>'
)
"""For the panel of a page; the one in force is bold."""


def with_ours(page: str, times: Array = NO_TIMES, plots: Sequence[Plot] = ()) -> str:
    """A page of viser's with our script, and plots (see `plot_strip`) under its view."""
    style, strip = plot_strip(times, plots)
    start, head, body = page.index("<head>") + 6, page.index("</head>"), page.rindex("</body>")
    ours = f"<script>{SCRIPT}</script>"
    return (
        f"{page[:start]}{ours}{page[start:head]}<style>{STYLE}</style>{style}{page[head:body]}"
        f"{strip}{page[body:]}"
    )


def viser_page() -> str:
    """The page that viser serves."""
    return (Path(viser.__file__).parent / "client" / "build" / "index.html").read_text("utf-8")


def own_server(
    page: str, host: str, port: int, title: str
) -> tuple[viser.ViserServer, TemporaryDirectory[str]]:
    """A server of viser that serves this page, and the folder that goes with it when it ends.

    viser has no door for a page of one's own, so its class of web servers is ours meanwhile.
    """
    theirs = infra.WebsockServer
    folder = TemporaryDirectory(prefix="uvms_view_")
    (Path(folder.name) / "index.html").write_text(page, encoding="utf-8")

    class Ours(theirs):  # type: ignore[misc,valid-type]
        def __init__(self, *args: Any, **more: Any) -> None:
            super().__init__(*args, **more | {"http_server_root": Path(folder.name)})

    infra.WebsockServer = Ours  # type: ignore[misc]
    try:
        return quiet_server(host, port, title), folder
    finally:
        infra.WebsockServer = theirs  # type: ignore[misc]


def quiet_server(host: str, port: int, title: str) -> viser.ViserServer:
    """A server of viser without its banner."""
    with redirect_stdout(StringIO()):
        return viser.ViserServer(host, port, title, verbose=False)


def stop_quietly(server: viser.ViserServer) -> None:
    """End a server without its message."""
    with redirect_stdout(StringIO()):
        server.stop()
