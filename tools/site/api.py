"""Hook of mkdocs: a page of reference for every module, from its docstrings."""

import ast
from collections.abc import Iterator
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parents[2]
PACKAGES = {
    "uvms_core": "src/uvms_core",
    "uvms_dynamics": "src/uvms_dynamics",
    "uvms_observer": "src/uvms_observer",
    "uvms_planner": "src/uvms_planner",
    "uvms_control": "src/uvms_control",
    "uvms_analysis": "src/uvms_analysis",
    "uvms_bringup": "bringup",
}
PLACE = "api"


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add a page for each package, with a line for each of its modules, and one for each module."""
    rows = []
    for package, folder in PACKAGES.items():
        modules = dict(_modules(ROOT / folder, package))
        rows.append(f"| [{package}]({package}.md) | {modules.get(package, '')} |")
        files.append(
            File.generated(config, f"{PLACE}/{package}.md", content=_index(package, modules))
        )
        for module in set(modules) - {package}:
            files.append(File.generated(config, _page(module), content=f"::: {module}\n"))
    text = "# API reference\n\n| package | what |\n|---|---|\n" + "\n".join(rows) + "\n"
    files.append(File.generated(config, f"{PLACE}/index.md", content=text))
    return files


def _modules(folder: Path, package: str) -> Iterator[tuple[str, str]]:
    """Names of modules and the first line of their docstrings."""
    for path in sorted((folder / package).rglob("*.py")):
        parts = path.relative_to(folder).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        described = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
        if described:
            yield name, described.splitlines()[0]


def _page(module: str) -> str:
    package, _, name = module.partition(".")
    return f"{PLACE}/{package}/{name}.md"


def _index(package: str, modules: dict[str, str]) -> str:
    """The package's own docstring, then its modules."""
    lines = [f"# {package}", "", modules.get(package, ""), "", "| module | what |", "|---|---|"]
    for module, line in modules.items():
        if module != package:
            name = module.partition(".")[2]
            lines.append(f"| [{name}]({package}/{name}.md) | {line} |")
    return "\n".join(lines) + "\n"
