"""Movies of a run without browser: GIF, or MP4 by the ffmpeg that a package brings along."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from PIL import Image

from uvms_bringup.errors import ViewError
from uvms_bringup.viewer.cameras import FOLLOWING, view_of
from uvms_bringup.viewer.log_source import LogSource
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
    """A camera that does not follow stays where it is at the start of the times."""
    model = SceneModel(source.setting)
    first = model.all_places(source.moment(float(times[0])))
    view = preset if preset in FOLLOWING else view_of(preset, model, first)
    for time in times:
        yield picture(model, source.moment(float(time)), view, source.name, SIZE, deep)


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
