"""The viewer's pictures in the documentation show what the viewer shows today."""

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


def _gallery():
    spec = importlib.util.spec_from_file_location("gallery", ROOT / "tools/pictures/gallery.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GALLERY = _gallery()
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


def test_pictures_and_movie_are_there_and_small():
    for name in SHOTS:
        with Image.open(FIGURES / f"view_{name}.png") as picture:
            assert picture.size == (1280, 720)
    movie = FIGURES / f"view_{GALLERY.MOVIE.name}.gif"
    assert movie.stat().st_size < 2e6
    with Image.open(movie) as frames:
        assert frames.n_frames >= 50
    kept = {path.stem for path in FIGURES.glob("view_*")}
    assert kept == {f"view_{name}" for name in [*SHOTS, GALLERY.MOVIE.name]}
