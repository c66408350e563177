"""The commands of tour and gallery are those of today, and print what the tour says."""

import re
import runpy
import shlex
from pathlib import Path

import pytest

from uvms_bringup.cli import main, parser
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
PRINTS = ("end effector off", "vehicle off", "navigation off", "roll:", "pitch:", "event:")
"""What does not differ from machine to machine of what a run prints."""
TOLD = [
    tuple(block.splitlines())
    for block in BLOCK.findall(PAGES["tour.md"])
    if block.startswith("uvms simulate")
]


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


@pytest.mark.parametrize("told", TOLD, ids=lambda told: told[0][:60])
def test_a_run_prints_what_the_tour_says(told, in_examples, tmp_path, capsys):
    command, _, _ = told[0].partition(" --output ")
    assert main([*words(command), "--output", str(tmp_path / "run")]) == 0
    printed = capsys.readouterr().out.splitlines()
    lines = [line for line in told if line.startswith(PRINTS)]
    assert len(lines) >= 3
    for line in lines:
        assert any(near(line, now) for now in printed), (line, printed)
    assert "outcome: completed" in printed
    wrong = lines[0].replace(re.findall(r"[\d.]+", lines[0])[0], "999")
    assert not any(near(wrong, now) for now in printed)


def test_the_gallery_shows_every_picture_with_its_command():
    shown = set(re.findall(r"\(figures/([^)]+)\)", PAGES["gallery.md"]))
    assert shown == {path.name for path in (DOCS / "figures").iterdir() if path.suffix != ".json"}
    kept = runpy.run_path(str(ROOT / "tools/pictures/gallery.py"))
    for shot in (*kept["GALLERY"], kept["MOVIE"]):
        made = ["simulate", *shot.arguments, "--output", f"runs/{shot.name}"]
        assert made in [words(line) for line in COMMANDS]
    for shot in kept["GALLERY"]:
        drawn = ["--at", f"{shot.at_s:g}", "--camera", shot.camera]
        assert any(words(line)[-4:] == drawn for line in COMMANDS if f"/{shot.name} " in line)
