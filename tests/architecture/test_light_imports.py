"""What must start quickly loads nothing heavy, and no core loads ROS."""

import json
import subprocess
import sys

import pytest
from project import PACKAGES, modules

CAMPAIGNS = ("dask", "distributed", "pyarrow", "pandas")
HEAVY = ("numba", "scipy", "rclpy", "matplotlib", "mcap", "rich", "capytaine", *CAMPAIGNS)
OF_HELP = (*HEAVY, "numpy", "yaml")


def loaded(code, names):
    """Which of the packages a new interpreter has loaded after running the code."""
    report = f"import json, sys; print(json.dumps([n for n in {names!r} if n in sys.modules]))"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{report}"], capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout.splitlines()[-1])


def command_line(words):
    """Code that runs `uvms` with these words, which print and exit."""
    return f"""
import contextlib
with contextlib.suppress(SystemExit):
    from uvms_bringup.cli import main
    main({words!r})
"""


def core_modules():
    """Modules of uvms_core that users of its common ground import."""
    own = PACKAGES["uvms_core"]
    files = [file for file in modules("uvms_core") if "ros" not in file.relative_to(own).parts]
    names = [".".join(file.relative_to(own).with_suffix("").parts) for file in files]
    # The only one with splines; planner and analysis import it for their paths.
    return [name for name in names if name != "uvms_core.end_effector_path"]


def test_the_common_ground_is_light():
    names = core_modules()
    assert len(names) > 40
    assert loaded(f"import {', '.join(names)}", HEAVY) == []


@pytest.mark.parametrize("package", PACKAGES)
def test_no_package_loads_ros(package):
    assert loaded(f"import {package}", ("rclpy", "uvms_msgs")) == []


@pytest.mark.parametrize("words", [["--help"], ["--version"], [], ["nonsense"]])
def test_the_command_line_is_there_at_once(words):
    """`uvms --help` needs no more than pydantic; a command's imports wait until it is chosen."""
    assert loaded(command_line(words), OF_HELP) == []


@pytest.mark.parametrize(
    "command",
    ["run", "simulate", "campaign", "compare", "replay", "report", "validate", "identify"],
)
def test_the_help_of_a_command_needs_no_kernels(command):
    assert loaded(command_line([command, "--help"]), HEAVY) == []


def test_a_single_run_needs_nothing_of_campaigns():
    code = """
from uvms_bringup.commands import run, simulate
from uvms_bringup.scenario import load_scenario
from uvms_bringup import session
"""
    assert loaded(code, CAMPAIGNS) == []
