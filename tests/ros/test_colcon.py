"""The same sources build in a ROS 2 workspace, and `ros2 run` finds the nodes there."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
BIN = Path(sys.prefix) / "bin"
NODES = [
    ("uvms_dynamics", "plant"),
    ("uvms_observer", "navigation"),
    ("uvms_observer", "disturbance_observer"),
    ("uvms_planner", "motion_planner"),
    ("uvms_control", "controller"),
    ("uvms_control", "thrust_allocator"),
]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def workspace(tmp_path_factory):
    """An installation made by `colcon build`, with this environment's ROS as its underlay."""
    place = tmp_path_factory.mktemp("workspace")
    packages = [str(folder) for folder in sorted((ROOT / "src").iterdir())]
    command = [BIN / "colcon", "--log-base", place / "log", "build"]
    command += ["--base-paths", *packages, ROOT / "bringup"]
    command += ["--build-base", place / "build", "--install-base", place / "install"]
    command += ["--merge-install", "--event-handlers", "console_direct+"]
    command += ["--cmake-args", "-DBUILD_TESTING=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
    environment = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}"}
    environment["AMENT_PREFIX_PATH"] = sys.prefix
    built = subprocess.run(
        list(map(str, command)), cwd=place, env=environment, capture_output=True, text=True
    )
    assert built.returncode == 0, built.stdout[-5000:] + built.stderr[-5000:]
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
    command = "python -c 'from uvms_core.vehicle import locate; print(*locate.known_vehicles())'"
    assert in_workspace(workspace, command).split() == ["bluerov2_alpha5", "reference_auv"]
