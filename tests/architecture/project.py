"""What the architecture tests look at: packages, files and their imports."""

import ast
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = {
    "uvms_core": ROOT / "src/uvms_core",
    "uvms_dynamics": ROOT / "src/uvms_dynamics",
    "uvms_observer": ROOT / "src/uvms_observer",
    "uvms_planner": ROOT / "src/uvms_planner",
    "uvms_control": ROOT / "src/uvms_control",
    "uvms_analysis": ROOT / "src/uvms_analysis",
    "uvms_bringup": ROOT / "bringup",
}
INTERFACES = ROOT / "src/uvms_msgs"
CODE = ("src", "bringup", "tests", "tools", "benchmarks", "examples")


DISTRIBUTIONS = {
    "PIL": "pillow",
    "annotated_types": "annotated-types",
    "imageio_ffmpeg": "imageio-ffmpeg",
    "mcap_ros2": "mcap-ros2-support",
    "pinocchio": "pin",
    "pydantic_core": "pydantic",  # which pins it
    "ruamel": "ruamel.yaml",
    "yaml": "PyYAML",
}
"""What is installed under another name than it is imported by."""
ROS = {
    "rclpy",
    "builtin_interfaces",
    "rcl_interfaces",
    "rosidl_parser",
    "rosidl_runtime_py",
    "std_srvs",
    "ament_index_python",
    "launch",
    "launch_ros",
}


def is_ros(name: str) -> bool:
    """Whether a package of this name comes with ROS 2."""
    return name in ROS or name.endswith("_msgs")


def setup_arguments(folder: Path) -> dict[str, Any]:
    """Keyword arguments of a package's setup() that are written as constants."""
    tree = ast.parse((folder / "setup.py").read_text(encoding="utf-8"))
    call = next(
        node
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "setup"
    )
    constants = {}
    for keyword in call.keywords:
        with suppress(ValueError):
            constants[keyword.arg] = ast.literal_eval(keyword.value)
    return constants


def manifest(folder: Path) -> ElementTree.Element:
    """The root element of a package.xml."""
    return ElementTree.parse(folder / "package.xml").getroot()


def required(package: str, extra: str | None = None) -> set[str]:
    """Names of the distributions that a package requires, or that one of its extras adds."""
    arguments = setup_arguments(PACKAGES[package])
    extras = arguments.get("extras_require", {})
    wanted = arguments["install_requires"] if extra is None else extras.get(extra, [])
    return {Requirement(line).name for line in wanted}


def modules(package: str) -> list[Path]:
    """Source files of a package's Python code."""
    return sorted((PACKAGES[package] / package).rglob("*.py"))


def python_files() -> list[Path]:
    """Every Python file of the project."""
    return sorted(file for folder in CODE for file in (ROOT / folder).rglob("*.py"))


def imports(file: Path) -> Iterator[str]:
    """Top-level names of all that the file imports, wherever in the file."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.split(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and not node.level:
            yield node.module.split(".")[0]
