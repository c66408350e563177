"""One file to share: the scene with its motion in a page that needs neither server nor network."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np
import viser

from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.cameras import WIDE, view_of
from uvms_bringup.viewer.drawing import Drawing, light
from uvms_bringup.viewer.front_page import quiet_server, stop_quietly, with_ours
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.scene_model import SceneModel

FRAMES = 1500
"""At most, evenly over the run: a run of 900 s then takes some 10 MB."""
SHORTEST_S = 0.05
"""Between frames: the eye does not ask for more than 20 a second."""
EVENT_S = 5.0
"""For how long the text of an event stays in the scene, or a hundredth of the run where longer."""


def export(source: LogSource, file: str | Path, frames: int = FRAMES) -> Path:
    """Write the run as a page and return its file; the page plays in the run's own time.

    Raises:
        LogError: the log cannot be read.
        ViewError: the file cannot be written.
    """
    path = Path(file)
    try:
        path.touch()  # before the work, which takes its time
        times = frame_times(source.start_s, source.end_s, frames)
        over = source.overview
        page = with_ours(_recorded(source, times), over.times, over.plots())
        path.write_text(page, encoding="utf-8")
    except OSError as fault:
        raise ViewError(f"{path}: cannot be written: {fault.strerror}") from fault
    return path


def frame_times(start: float, end: float, frames: int) -> np.ndarray:
    """Times of the frames in s, evenly, no closer than `SHORTEST_S`."""
    count = min(frames, int((end - start) / SHORTEST_S) + 1)
    return np.linspace(start, end, max(count, 2))


def _recorded(source: LogSource, times: np.ndarray) -> str:
    """The page as HTML."""
    model = SceneModel(source.setting)
    with scene_server() as server:
        places = model.all_places(source.moment(float(times[0])))
        light(server.scene)
        drawing = Drawing(server.scene, model.nodes, model.still, model.line_m)
        drawing.show(places)
        view = view_of(WIDE, model, places)
        server.initial_camera.position = view.position
        server.initial_camera.look_at = view.look_at
        event = server.scene.add_label(f"/{model.shown_root(places)}/event", "", visible=False)
        recording = server.get_scene_serializer()
        for before, now in pairwise(times):
            recording.insert_sleep(float(now - before))
            drawing.show(model.places(source.moment(float(now))))
            text = _event(source, float(now))
            if event.text != text:
                event.text, event.visible = text, bool(text)
        return recording.as_html()


def _event(source: LogSource, time: float) -> str:
    stays = max(EVENT_S, 0.01 * (source.end_s - source.start_s))
    texts = [f"{at:.1f} s: {text}" for at, text in source.events if 0.0 <= time - at < stays]
    return texts[-1] if texts else ""


@contextmanager
def scene_server() -> Iterator[viser.ViserServer]:
    """A server that nobody is to look at, as viser records only what a server has."""
    server = quiet_server("127.0.0.1", 0, "UVMS")
    try:
        yield server
    finally:
        stop_quietly(server)
