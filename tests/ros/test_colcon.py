"""The same sources build in a ROS 2 workspace, and `ros2 run` finds the nodes there."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from uvms_core.vehicle.locate import known_vehicles

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(sys.prefix) / "bin"
ALL = [*sorted(file.parent for file in (ROOT / "src").glob("*/package.xml")), ROOT / "bringup"]
NODES = [
    ("uvms_dynamics", "plant"),
    ("uvms_observer", "navigation"),
    ("uvms_observer", "disturbance_observer"),
    ("uvms_planner", "motion_planner"),
    ("uvms_control", "controller"),
    ("uvms_control", "thrust_allocator"),
]
SOME = ("--pytest-args", "-k", "topics")
"""Whoever tests all runs the tests themselves, too."""

pytestmark = pytest.mark.slow


def colcon(place, verb, *options, packages=ALL):
    """Run a colcon command on packages of the project, with this environment as the underlay."""
    command = [BIN / "colcon", "--log-base", place / "log", verb, "--base-paths", *packages]
    command += ["--build-base", place / "build", "--install-base", place / "install"]
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}
    environment["AMENT_PREFIX_PATH"] = sys.prefix
    done = subprocess.run(
        list(map(str, [*command, *options])),
        cwd=place,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-5000:]


def results(place):
    """Numbers of tests, errors, failures and skipped tests that `colcon test-result` reports."""
    command = [BIN / "colcon", "test-result", "--test-result-base", place / "build"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True)
    pattern = r"Summary: (\d+) tests, (\d+) errors, (\d+) failures, (\d+) skipped"
    return tuple(map(int, re.search(pattern, done.stdout).groups()))


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """An installation made by `colcon build`, with this environment's ROS as its underlay."""
    place = tmp_path_factory.mktemp("workspace")
    build = ["--merge-install", "--event-handlers", "console_direct+", "--cmake-args"]
    build += ["-DBUILD_TESTING=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
    colcon(place, "build", *build)
    return place / "install"


def in_workspace(install, command):
    """Output of a shell command in a shell that has sourced the workspace."""
    script = f"set -e; . {install}/local_setup.sh; {command}"
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}
    environment.pop("PYTHONPATH", None)
    answer = subprocess.run(
        ["sh", "-c", script], env=environment, cwd=install, capture_output=True, text=True
    )
    assert answer.returncode == 0, answer.stderr
    return answer.stdout.strip()


@pytest.mark.parametrize(("package", "node"), NODES)
def test_node_is_where_ros2_run_looks(workspace, package, node):
    program = workspace / "lib" / package / node
    assert program.is_file()
    assert os.access(program, os.X_OK)
    assert (workspace / "share/ament_index/resource_index/packages" / package).is_file()
    assert (workspace / "share" / package / "package.xml").is_file()


@pytest.mark.parametrize(("package", "node"), NODES)
def test_node_can_be_loaded(workspace, package, node):
    command = f"from {package}.nodes.{node} import main; print(callable(main))"
    assert in_workspace(workspace, f"python -c '{command}'") == "True"


@pytest.mark.parametrize(("package", "node"), NODES)
def test_node_is_in_the_environment_too(package, node):
    program = Path(sys.prefix) / "lib" / package / node
    assert os.access(program, os.X_OK)


@pytest.mark.parametrize("module", ["uvms_msgs.msg", "uvms_msgs.action"])
def test_interfaces_come_from_the_workspace(workspace, module):
    place = in_workspace(workspace, f"python -c 'import {module} as m; print(m.__file__)'")
    assert place.startswith(str(workspace))


@pytest.mark.parametrize(
    "package",
    [
        "uvms_core",
        "uvms_dynamics",
        "uvms_observer",
        "uvms_planner",
        "uvms_control",
        "uvms_analysis",
        "uvms_bringup",
    ],
)
def test_python_packages_come_from_the_workspace(workspace, package):
    command = f"python -c 'import {package} as m; print(m.__file__)'"
    assert in_workspace(workspace, command).startswith(str(workspace))


def test_configuration_is_shared(workspace):
    """A run from the workspace finds scenarios and vehicles without the source tree."""
    shared = workspace / "share/uvms_bringup/config/scenarios"
    scenarios = {file.name for file in (ROOT / "bringup/config/scenarios").glob("*.yaml")}
    assert {file.name for file in shared.iterdir()} == scenarios
    campaigns = {file.name for file in (ROOT / "bringup/config/campaigns").glob("*.yaml")}
    assert {file.name for file in (shared.parent / "campaigns").glob("*.yaml")} == campaigns
    assert (workspace / "share/uvms_bringup/launch/uvms.launch.py").is_file()
    command = "python -c 'from uvms_core.vehicle import locate; print(*locate.known_vehicles())'"
    assert in_workspace(workspace, command).split() == list(known_vehicles())


def test_colcon_test_runs_the_tests_of_a_package(workspace):
    """Every package points to its tests in the same way (tests/architecture); some of one run."""
    place = workspace.parent
    some = ("--packages-select", "uvms_core", *SOME)
    colcon(place, "test", "--merge-install", *some)
    tests, *faults = results(place)
    assert tests > 5
    assert faults == [0, 0, 0]


def test_colcon_test_needs_no_merged_workspace(tmp_path):
    """A folder for each package: it sees only what it depends on."""
    core = [ROOT / "src/uvms_core"]
    colcon(tmp_path, "build", packages=core)
    colcon(tmp_path, "test", *SOME, packages=core)
    tests, *faults = results(tmp_path)
    assert tests > 5
    assert faults == [0, 0, 0]
