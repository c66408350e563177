"""The pictures of viewer and report in the documentation show what these show today."""

import importlib.util
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from uvms_bringup.cli import main
from uvms_bringup.viewer.describe import describe
from uvms_bringup.viewer.log_source import LogSource
from uvms_bringup.viewer.scene_model import SceneModel

ROOT = Path(__file__).parents[2]
FIGURES = ROOT / "docs" / "figures"
NEAR_M = 0.05
"""A picture is current while nothing in it is farther from its place than this."""
AGAIN = "`make pictures` makes the pictures of the viewer again"


def _tool(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / f"tools/pictures/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GALLERY, REPORT = _tool("gallery"), _tool("report_shot")
SHOTS = {shot.name: shot for shot in GALLERY.GALLERY}


def differences(kept, now):
    """What one description has and the other has not, in words."""
    found = list(kept["shown"].keys() ^ now["shown"].keys())
    for name in kept["shown"].keys() & now["shown"].keys():
        (*look, place), (*new_look, new_place) = kept["shown"][name], now["shown"][name]
        if look[:2] != new_look[:2] or np.linalg.norm(np.subtract(place, new_place)) > NEAR_M:
            found.append(f"{name}: {kept['shown'][name]} is {now['shown'][name]}")
    if np.abs(np.subtract(kept["camera"], now["camera"])).max() > NEAR_M:
        found.append(f"camera: {kept['camera']} is {now['camera']}")
    return found


@pytest.mark.parametrize("name", SHOTS)
def test_a_picture_is_current(name, tmp_path):
    shot, folder = SHOTS[name], tmp_path / "run"
    assert main(["simulate", *shot.arguments, "--output", str(folder)]) in (0, 1)
    source = LogSource(folder)
    model = SceneModel(source.setting)
    now = describe(model, source.moment(shot.at_s), shot.camera)
    kept = json.loads((FIGURES / f"view_{name}.json").read_text())
    assert kept["arguments"] == shot.arguments, AGAIN
    assert differences(kept, now) == [], AGAIN
    other = json.loads((FIGURES / f"view_{name}.json").read_text())
    other["shown"]["estimated/light_port"][-1][2] += 0.1
    assert differences(other, now)  # a light 10 cm lower would be told


@pytest.fixture(scope="module")
def swing(tmp_path_factory):
    """The run of the movie and of the report's picture."""
    folder = tmp_path_factory.mktemp("swing") / "run"
    assert main(["simulate", *GALLERY.MOVIE.arguments, "--output", str(folder)]) == 0
    return folder


def test_the_movie_is_current(swing):
    kept = json.loads((FIGURES / f"view_{GALLERY.MOVIE.name}.json").read_text())
    now = GALLERY.movie_told(LogSource(swing))
    assert (kept["arguments"], kept["speed"]) == (GALLERY.MOVIE.arguments, now["speed"]), AGAIN
    assert differences(kept, now) == [], AGAIN
    kept["shown"]["23 s: estimated/tool"][-1][0] += 0.1
    assert differences(kept, now)  # an arm elsewhere would be told


def test_the_picture_of_the_report_is_current(swing, capsys):
    assert main(["report", str(swing)]) == 0
    now = REPORT.told((swing / "report.html").read_text(encoding="utf-8"))
    kept = json.loads((FIGURES / "report.json").read_text())
    assert kept["arguments"] == GALLERY.MOVIE.arguments, AGAIN
    assert kept["questions"] == now["questions"], AGAIN
    assert len(now["figures"]) >= 5
    assert kept["figures"].keys() == now["figures"].keys(), AGAIN
    for title, (value, unit) in now["figures"].items():
        assert kept["figures"][title] == [pytest.approx(value, rel=0.05), unit], (title, AGAIN)


def test_pictures_and_movie_are_there_and_small():
    for name in SHOTS:
        with Image.open(FIGURES / f"view_{name}.png") as picture:
            assert picture.size == (1280, 720)
    movie = FIGURES / f"view_{GALLERY.MOVIE.name}.gif"
    assert movie.stat().st_size < 4e5
    with Image.open(movie) as frames:
        assert frames.n_frames >= 50
    assert (FIGURES / "report.png").stat().st_size < 3e5
    kept = {path.stem for path in FIGURES.glob("view_*")}
    assert kept == {f"view_{name}" for name in [*SHOTS, GALLERY.MOVIE.name]}
