"""The commands of tour and gallery are those of today, and print what the tour says."""

import re
import runpy
import shlex
from pathlib import Path

import pytest

from uvms_bringup.cli import parser
from uvms_bringup.scenario import load_scenario

ROOT = Path(__file__).parents[2]
DOCS, EXAMPLES = ROOT / "docs", ROOT / "examples"
PAGES = {name: (DOCS / name).read_text(encoding="utf-8") for name in ("tour.md", "gallery.md")}
BLOCK = re.compile(r"^```\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMANDS = [
    line
    for page in PAGES.values()
    for block in BLOCK.findall(page)
    for line in block.splitlines()
    if line.startswith("uvms ")
]
PICTURES = runpy.run_path(str(ROOT / "tools/pictures/gallery.py"))
TOUR = runpy.run_path(str(ROOT / "tools/pictures/printed.py"))
TOLD = TOUR["blocks"](PAGES["tour.md"])
AGAIN = "`make pictures ARGS=tour` writes into docs/tour.md what its commands print today"
OF_THE_MACHINE = "simulated:"


def words(line):
    return shlex.split(line, comments=True)[1:]


@pytest.fixture
def in_examples(monkeypatch):
    """Where a module of the examples is found."""
    monkeypatch.chdir(EXAMPLES)
    monkeypatch.syspath_prepend(str(EXAMPLES))


@pytest.mark.parametrize("line", COMMANDS)
def test_a_command_is_understood(line, in_examples):
    name, *rest = words(line)
    options = parser(name).parse_args([name, *rest])
    if name == "simulate":
        assert load_scenario(options.scenario, options.set or ()).duration_s > 0.0


def near(told, now):
    """Whether two lines say the same but for the last digits of their numbers."""
    number = r"-?\d+(?:\.\d+)?"
    if re.sub(number, "#", told) != re.sub(number, "#", now):
        return False
    pairs = zip(re.findall(number, told), re.findall(number, now), strict=True)
    return all(float(a) == pytest.approx(float(b), rel=0.1) for a, b in pairs)


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """The blocks as they are made of today's runs."""
    page = TOUR["printed_again"](PAGES["tour.md"], tmp_path_factory.mktemp("tour"))
    return TOUR["blocks"](page)


def test_the_tour_has_runs_and_a_comparison():
    assert sum(told[0].startswith("uvms simulate ") for told in TOLD) >= 3
    assert sum(told[0].startswith("uvms compare ") for told in TOLD) == 1
    assert all(len(told) > 3 for told in TOLD)


@pytest.mark.parametrize("number", range(len(TOLD)), ids=lambda k: TOLD[k][0][:60])
def test_a_command_prints_what_the_tour_says(number, printed):
    for told, now in zip(TOLD[number], printed[number], strict=True):
        if not told.startswith(OF_THE_MACHINE):
            assert near(told, now), (told, now, AGAIN)


def test_another_number_is_not_what_the_tour_says():
    line = next(line for line in TOLD[0] if line.startswith("roll:"))
    assert near(line, line)
    assert not near(line, line.replace(re.findall(r"[\d.]+", line)[0], "999"))


def test_a_line_that_is_not_printed_any_more_is_named(tmp_path):
    page = "```\nuvms simulate hover --duration 0.5 --output a\ntemperature: 4 K\n```\n"
    with pytest.raises(LookupError, match=r"prints no line .* of 'temperature'"):
        TOUR["printed_again"](page, tmp_path)


def test_the_gallery_shows_every_picture_with_its_command():
    shown = set(re.findall(r"\(figures/([^)]+)\)", PAGES["gallery.md"]))
    assert shown == {path.name for path in (DOCS / "figures").iterdir() if path.suffix != ".json"}
    for shot in (*PICTURES["GALLERY"], PICTURES["MOVIE"]):
        made = ["simulate", *shot.arguments, "--output", f"runs/{shot.name}"]
        assert made in [words(line) for line in COMMANDS]
    for shot in PICTURES["GALLERY"]:
        drawn = ["--at", f"{shot.at_s:g}", "--camera", shot.camera]
        assert any(words(line)[-4:] == drawn for line in COMMANDS if f"/{shot.name} " in line)
