"""Movies of a run without browser: GIF, or MP4 by the ffmpeg that a package brings along."""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.cameras import FOLLOWING, View, view_of
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.moment import Moment
from uvms_bringup.viewer.picture import DEEP, SKY, picture
from uvms_bringup.viewer.scene_model import SceneModel
from uvms_core.signals import Array

SIZE = (640, 360)
RATES = {".gif": 8, ".mp4": 25}
"""Frames a second by the file's suffix."""
COLOURS = 128
"""Of a GIF, whose background is of one: a slow change of colour would be steps in it."""
PALETTE_FRAMES = 6
"""From which the colours of a GIF are taken, evenly over it."""
LOOKS, STAYS = 30, 0.5
"""How often it is asked where the vehicle is, and how far it may go, in diagonals of its hull,
while the camera stands still, which makes a movie calm and a GIF small."""
LONGEST_S = 10.0
"""Of a movie for which no speed is asked: the run is played so much faster."""


def write_movie(
    source: LogSource,
    file: str | Path,
    preset: str,
    span: tuple[float, float] | None = None,
    speed: float | None = None,
) -> Path:
    """Draw a run, or a span of it in s, into a movie that plays `speed` times real time.

    Raises:
        LogError: the log cannot be read.
        ViewError: the file cannot be written or is neither GIF nor MP4; the run has no such span.
    """
    path = Path(file)
    if path.suffix not in RATES:
        raise ViewError(f"{path}: a movie ends in one of {', '.join(RATES)}")
    start, end = span or (source.start_s, source.end_s)
    source.check_span(start, end)
    speed = max((end - start) / LONGEST_S, 1.0) if speed is None else speed
    rate = RATES[path.suffix]
    times = np.arange(start, end, speed / rate)
    try:
        path.touch()  # before the work, which takes its time
        if path.suffix == ".gif":
            few = times[:: max(len(times) // PALETTE_FRAMES, 1)]
            palette = _palette(list(_frames(source, few, preset, SKY)))
            _write_gif(path, _frames(source, times, preset, SKY), rate, palette)
        else:
            _write_mp4(path, _frames(source, times, preset), rate)
    except OSError as fault:
        raise ViewError(f"{path}: cannot be written: {fault}") from fault
    return path


def _frames(
    source: LogSource, times: np.ndarray, preset: str, deep: Array = DEEP
) -> Iterator[Image.Image]:
    model = SceneModel(source.setting)
    view = preset if preset in FOLLOWING else held(source.moment, model, times, preset)
    for time in times:
        yield picture(model, source.moment(float(time)), view, source.name, SIZE, deep)


def held(
    moment: Callable[[float], Moment], model: SceneModel, times: np.ndarray, preset: str
) -> View | str:
    """The view at the first time where the vehicle stays about there, else one that follows."""
    few = times[:: max(len(times) // LOOKS, 1)]
    views = [view_of(preset, model, model.all_places(moment(float(time)))) for time in few]
    gone = max(float(np.linalg.norm(view.look_at - views[0].look_at)) for view in views)
    return views[0] if gone < STAYS * model.diagonal else preset


def _palette(frames: list[Image.Image]) -> Image.Image:
    """The colours of some frames, which all then share, so that nothing flickers.

    An octree keeps those of small things, such as the side lights.
    """
    joined = Image.fromarray(np.vstack([np.asarray(frame) for frame in frames]))
    return joined.quantize(COLOURS, Image.Quantize.FASTOCTREE)


def _write_gif(path: Path, frames: Iterator[Image.Image], rate: int, palette: Image.Image) -> None:
    each = (frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames)
    first = next(each)
    first.save(path, save_all=True, append_images=each, duration=round(1000 / rate), loop=0)


def _write_mp4(path: Path, frames: Iterator[Image.Image], rate: int) -> None:
    from imageio_ffmpeg import write_frames

    writer = write_frames(str(path), SIZE, fps=rate, macro_block_size=8, ffmpeg_log_level="error")
    writer.send(None)
    for frame in frames:
        writer.send(np.ascontiguousarray(frame))
    writer.close()
