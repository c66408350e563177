"""`make bench`: the form of its output, without measuring much."""

import json
import subprocess
import sys

import pytest
from project import ROOT

PROGRAM = ROOT / "benchmarks" / "run.py"
KEYS = ["name", "value", "unit", "reference", "ratio", "target", "met"]


def bench(*arguments):
    return subprocess.run(
        [sys.executable, str(PROGRAM), *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )


@pytest.fixture
def figures(monkeypatch):
    """The module of that name, which is no package."""
    monkeypatch.syspath_prepend(str(PROGRAM.parent))
    yield __import__("figures")
    sys.modules.pop("figures", None)


def test_list_tells_what_every_file_measures():
    done = bench("--list")
    assert done.returncode == 0, done.stderr
    listed = {line.split()[0] for line in done.stdout.splitlines()}
    assert listed == {path.stem for path in (PROGRAM.parent / "cases").glob("[!_]*.py")}
    assert all(len(line.split()) > 4 for line in done.stdout.splitlines())


def test_unknown_names_are_refused_with_the_choices():
    done = bench("allocation", "speed")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "unknown: speed; choose from allocation, arm_swing" in done.stderr


def test_every_line_is_one_object_with_the_agreed_keys():
    done = bench("plant")
    assert done.returncode == 0, done.stderr
    found = [json.loads(line) for line in done.stdout.splitlines()]
    assert found
    assert all(list(figure) == KEYS for figure in found)
    assert all(figure["met"] in (True, False, None) for figure in found)


@pytest.mark.parametrize(
    ("field", "sign", "bound", "met"),
    [("ratio", ">=", 2.0, True), ("ratio", ">=", 2.1, False), ("value", "<=", 4.0, False)],
)
def test_targets_are_judged_by_the_field_that_they_name(figures, field, sign, bound, met):
    target = figures.Target(field, sign, bound)
    line = figures.Figure("a", 5.0, "us", "b", 2.0, target).line()
    assert json.loads(line)["met"] is met
    assert json.loads(line)["target"] == f"{field} {sign} {bound:g}"


def test_what_was_not_measured_meets_no_target(figures):
    line = figures.Figure("a", 5.0, "us", target=figures.Target("ratio", ">=", 0.0)).line()
    assert json.loads(line)["met"] is False
