"""What the architecture tests look at: packages, files and their imports."""

import ast
from collections.abc import Iterator
from pathlib import Path

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
