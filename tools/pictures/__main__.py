"""Make the pictures of viewer and report, the movie, and what the tour prints: `make pictures`.

`make pictures ARGS=tour` makes only the last of them, in a few seconds.
"""

import json
import sys
import tempfile
from pathlib import Path
from typing import Any

from gallery import GALLERY, MOVIE, MOVIE_SPEED, Shot, movie_told
from printed import PAGE, printed_again
from report_shot import photograph
from report_shot import told as report_told

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


def film(folder: Path) -> LogSource:
    """The movie and its description; the run."""
    source = simulated(MOVIE, folder)
    file = FIGURES / f"view_{MOVIE.name}.gif"
    print(write_movie(source, file, MOVIE.camera, speed=MOVIE_SPEED), file=sys.stderr)
    told = _lines({"arguments": MOVIE.arguments, **movie_told(source)})
    file.with_suffix(".json").write_text(told)
    return source


def photograph_report(source: LogSource) -> None:
    """The picture of a run's report, and what it shows."""
    report, picture = report_of(source), FIGURES / "report.png"
    print(photograph(report, picture), file=sys.stderr)
    told = {"arguments": MOVIE.arguments, **report_told(report.read_text(encoding="utf-8"))}
    picture.with_suffix(".json").write_text(json.dumps(told, indent=1) + "\n")


def report_of(source: LogSource) -> Path:
    """Write the report of a run."""
    if main(["report", str(source.log.path)]) != 0:
        raise SystemExit(f"there is no report of {source.log.path}")
    return source.log.path.parent / "report.html"


def print_tour(folder: Path) -> None:
    """The numbers of docs/tour.md."""
    told = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(printed_again(told, folder), encoding="utf-8")
    print(PAGE, file=sys.stderr)


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["tour"]):
        raise SystemExit(
            f"make pictures: nothing is called {sys.argv[1:]}; choose tour, or no name"
        )
    with tempfile.TemporaryDirectory() as temporary:
        if not sys.argv[1:]:
            for each in GALLERY:
                draw(each, Path(temporary))
            photograph_report(film(Path(temporary)))
        print_tour(Path(temporary))
