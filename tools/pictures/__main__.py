"""Make the viewer's pictures and its movie in docs/figures again: `make pictures`."""

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

from gallery import GALLERY, MOVIE, MOVIE_SPEED, Shot

from uvms_bringup.cli import main
from uvms_bringup.viewer.describe import describe
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.movie import write_movie
from uvms_bringup.viewer.picture import write_picture
from uvms_bringup.viewer.scene_model import SceneModel

FIGURES = Path(__file__).parents[2] / "docs" / "figures"


def simulated(shot: Shot, folder: Path) -> LogSource:
    """The run of a picture."""
    run = folder / shot.name
    if main(["simulate", *shot.arguments, "--output", str(run), "--json"]) not in (0, 1):
        raise SystemExit(f"the run of {shot.name} could not be simulated")
    return LogSource(run)


def draw(shot: Shot, folder: Path) -> None:
    """A picture and its description."""
    source = simulated(shot, folder)
    model, moment = SceneModel(source.setting), source.moment(shot.at_s)
    picture = FIGURES / f"view_{shot.name}.png"
    print(write_picture(model, moment, picture, shot.camera, source.name), file=sys.stderr)
    told = describe(model, moment, shot.camera)
    picture.with_suffix(".json").write_text(_lines({"arguments": shot.arguments, **told}))


def _lines(told: dict[str, Any]) -> str:
    """JSON with one thing of the picture a line, so that a change of it is one, too."""
    things = ",\n  ".join(f"{json.dumps(k)}: {json.dumps(v)}" for k, v in told["shown"].items())
    rest = "".join(f" {json.dumps(k)}: {json.dumps(v)},\n" for k, v in told.items() if k != "shown")
    return f'{{\n{rest} "shown": {{\n  {things}\n }}\n}}\n'


def film(folder: Path) -> None:
    """The movie."""
    source = simulated(MOVIE, folder)
    file = FIGURES / f"view_{MOVIE.name}.gif"
    print(write_movie(source, file, MOVIE.camera, speed=MOVIE_SPEED), file=sys.stderr)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        for each in GALLERY:
            draw(each, Path(temporary))
        film(Path(temporary))
