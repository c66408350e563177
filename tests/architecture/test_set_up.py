"""`make setup`: does nothing twice, starts over after an interruption, names what is missing."""

import json
import os
import shutil
import subprocess
import sys

import pytest
from project import ROOT

TOOL = ROOT / "tools" / "environment"
LEFT_OUT = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "runs", "build")


def run(command, cwd, **variables):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("MAKE")}
    return subprocess.run(
        list(map(str, command)),
        cwd=cwd,
        env={**environment, **variables},
        capture_output=True,
        text=True,
        timeout=120,
    )


@pytest.fixture
def clone(tmp_path):
    """The project's sources without its environment."""
    return shutil.copytree(ROOT, tmp_path / "clone", ignore=LEFT_OUT)


@pytest.fixture
def tool(monkeypatch):
    """The set-up's own modules, which are no package."""
    monkeypatch.syspath_prepend(str(TOOL))
    names = ("machine", "stamps", "stages", "commands")
    yield {name: __import__(name) for name in names}
    for name in (*names, "chromium", "workspace"):
        sys.modules.pop(name, None)


def test_second_set_up_does_nothing():
    assert run(["make", "setup"], ROOT).returncode == 0
    stamp = ROOT / ".venv" / "setup.json"
    before = stamp.stat().st_mtime_ns
    answer = run(["make", "setup"], ROOT)
    assert (answer.returncode, answer.stdout, answer.stderr) == (0, "", "")
    assert stamp.stat().st_mtime_ns == before


@pytest.mark.parametrize("name", ["PYTHONPATH", "PYTHONDONTWRITEBYTECODE"])
def test_what_the_callers_environment_sets_stays_outside(tool, name, monkeypatch):
    """Without bytecode each process of a run would compile 1,400 files for itself."""
    show = f"--eval=show: ; @echo ${{{name}-none}}"
    assert run(["make", show.replace("$", "$$"), "show"], ROOT, **{name: "1"}).stdout == "none\n"
    monkeypatch.setenv(name, "1")
    assert name not in tool["commands"].environment(ROOT / ".venv")


def test_missing_tools_are_named_with_the_way_to_get_them(clone, tmp_path):
    (tmp_path / "empty").mkdir()
    command = [sys.executable, "-I", "-S", "tools/environment"]
    answer = run(command, clone, PATH=str(tmp_path / "empty"))
    assert answer.returncode == 1
    assert "cmake 3.19 or newer is missing: `sudo apt install cmake`" in answer.stderr
    assert "a C++ compiler (g++) is missing: `sudo apt install g++`" in answer.stderr
    assert not (clone / ".venv").exists()


def test_an_environment_of_the_user_is_left_alone(clone):
    precious = clone / ".venv" / "precious.txt"
    precious.parent.mkdir()
    precious.write_text("mine")
    answer = run([sys.executable, "-I", "-S", "tools/environment"], clone)
    assert answer.returncode == 1
    assert ".venv was not made by this set-up: move it away." in answer.stderr
    assert precious.read_text() == "mine"


def test_a_missing_requirements_file_is_named(clone):
    (clone / "requirements" / "ros.txt").unlink()
    answer = run([sys.executable, "-I", "-S", "tools/environment"], clone)
    assert answer.returncode == 1
    assert "requirements/ros.txt is missing; restore it with `git checkout`." in answer.stderr


def test_supported_pythons(tool):
    supported = tool["machine"].supported_python
    assert [minor for minor in range(6, 20) if supported((3, minor))] == [10, 11, 12, 13]


def test_a_stage_that_was_begun_counts_as_not_done(tool, tmp_path):
    stamps = tool["stamps"].Stamps(tmp_path / "setup.json")
    stamps.begin("runtime")
    stamps.end("runtime", "key")
    assert stamps.done("runtime", "key")
    assert not stamps.done("runtime", "another key")
    stamps.begin("runtime")
    again = tool["stamps"].Stamps(tmp_path / "setup.json")
    assert again.interrupted == "runtime"
    assert not again.done("runtime", "key")


def test_a_torn_stamp_counts_as_nothing_done(tool, tmp_path):
    (tmp_path / "setup.json").write_text('{"runtime": "ke')
    assert not tool["stamps"].Stamps(tmp_path / "setup.json").present


@pytest.mark.parametrize(
    ("change", "stages"),
    [
        ("src/uvms_msgs/msg/Reference.msg", {"interfaces"}),
        ("requirements/runtime.txt", {"runtime"}),
        ("requirements/development.txt", {"development"}),
        ("requirements/build.txt", {"runtime"}),
        ("requirements/ros.txt", {"ros", "interfaces"}),
        ("requirements/constraints.txt", {"runtime", "ros", "development"}),
        ("src/uvms_control/setup.py", {"packages"}),
        ("src/uvms_control/uvms_control/__init__.py", set()),
    ],
)
def test_a_change_concerns_only_its_stages(tool, clone, change, stages):
    def keys():
        context = tool["stages"].Context(clone)
        return {stage.name: stage.key(context, False) for stage in tool["stages"].plan(True)}

    before = keys()
    with (clone / change).open("a") as file:
        file.write("\n")
    after = keys()
    assert {name for name in after if after[name] != before[name]} == stages


@pytest.mark.parametrize(
    ("change", "compiles"),
    [
        ("src/uvms_observer/uvms_observer/navigation/propagation.py", True),
        ("src/uvms_observer/uvms_observer/parts.py", False),
    ],
)
def test_kernels_are_compiled_anew_where_one_has_changed(tool, clone, change, compiles):
    before = tool["stamps"].kernel_sources(clone)
    with (clone / change).open("a") as file:
        file.write("\n")
    assert (tool["stamps"].kernel_sources(clone) != before) is compiles


def test_the_stamp_of_this_environment_is_complete():
    stamp = json.loads((ROOT / ".venv" / "setup.json").read_text())
    stages = {"environment", "runtime", "packages", "ros", "development", "browser", "interfaces"}
    assert set(stamp) == stages | {"kernels"}
