"""What rests on numba's internals stays in its folder and names the versions it is for."""

import ast
from importlib.metadata import requires
from pathlib import Path

import numba
import pytest
from packaging.requirements import Requirement

import uvms_dynamics
from uvms_dynamics.kernels import compile_cache, numba_internals
from uvms_dynamics.kernels.numba_internals import SUPPORTED, check_version

FOLDER = Path(numba_internals.__file__).parent
INTERNAL = ("numba.core", "numba.np", "numba.cpython", "llvmlite")


def imported(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (each.name for each in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module
            yield from (f"{node.module}.{each.name}" for each in node.names)


def uses_internals(path):
    return any(
        name == module or name.startswith(module + ".")
        for name in imported(path)
        for module in INTERNAL
    )


def test_only_this_folder_imports_what_is_internal_to_numba():
    root = Path(uvms_dynamics.__file__).parents[3]
    sources = [path for folder in ("src", "bringup") for path in (root / folder).rglob("*.py")]
    users = {path for path in sources if uses_internals(path)}
    assert users
    assert {path for path in users if path.parent != FOLDER} <= {Path(compile_cache.__file__)}


def test_the_package_requires_the_supported_versions():
    needed = next(r for r in map(Requirement, requires("uvms_dynamics")) if r.name == "numba")
    least, beyond = (f"{major}.{minor}" for major, minor in SUPPORTED)
    assert {str(bound) for bound in needed.specifier} == {f">={least}", f"<{beyond}"}
    assert needed.specifier.contains(numba.__version__)


def test_bounds_of_the_version():
    least, beyond = SUPPORTED
    check_version(least)
    for wrong in ((least[0], least[1] - 1), beyond, (beyond[0] + 1, 0)):
        with pytest.raises(ImportError, match=r"^numba \d+\.\d+ is installed.* need >= 0\.61, < 0"):
            check_version(wrong)


def test_docstring_names_the_version_that_it_was_tried_with():
    assert f"numba {numba.__version__} " in numba_internals.__doc__
