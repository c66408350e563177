"""Compiled kernels are kept apart by the sources that they were made from."""

import ast
import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

from uvms_core import registry
from uvms_dynamics.kernels import compile_cache
from uvms_dynamics.kernels.compile_cache import fingerprint

DECORATORS = ("@njit", "@kernel", "@inner", "@exact_")
KERNEL_PACKAGES = registry.names(registry.KERNELS)


@pytest.fixture
def package(tmp_path):
    (tmp_path / "kernel.py").write_text("from numba import njit\n", encoding="utf-8")
    (tmp_path / "other.py").write_text("x = 1\n", encoding="utf-8")
    return tmp_path


def test_an_edited_kernel_changes_the_folder(package):
    before = fingerprint([package])
    assert fingerprint([package]) == before
    (package / "kernel.py").write_text("from numba import njit\ny = 2\n", encoding="utf-8")
    assert fingerprint([package]) != before


def test_other_files_do_not(package):
    before = fingerprint([package])
    (package / "other.py").write_text("x = 2\n", encoding="utf-8")
    assert fingerprint([package]) == before


def cache_folder(**environment):
    code = "import uvms_dynamics, numba; print(numba.config.CACHE_DIR)"
    result = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return result.stdout.strip()


def test_kernels_go_to_the_folder_of_their_sources():
    folders = list(compile_cache._folders())
    assert cache_folder().endswith(f"kernels-{fingerprint(folders)}")


def test_the_users_own_folder_is_respected(tmp_path):
    assert cache_folder(NUMBA_CACHE_DIR=str(tmp_path)) == str(tmp_path)


def constants_from_elsewhere(path):
    """(module, name) of each constant that a file imports from a package with kernels."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        module = getattr(node, "module", None) or ""
        if isinstance(node, ast.ImportFrom) and module.split(".")[0] in KERNEL_PACKAGES:
            yield from ((module, each.name) for each in node.names if each.name.isupper())


def test_constants_that_kernels_take_from_other_files_count_too():
    """numba compiles them in as they are; a file counts if its text mentions numba."""
    marks = ("@njit", "@kernel", "@inner", "@exact_", "@shared")
    kernels = [
        path
        for folder in compile_cache._folders()
        for path in folder.rglob("*.py")
        if any(mark in path.read_text("utf-8") for mark in marks)
    ]
    found = {constant for path in kernels for constant in constants_from_elsewhere(path)}
    assert len(found) > 20
    ignored = [
        (module, name)
        for module, name in found
        if not any(
            mark in Path(importlib.util.find_spec(module).origin).read_bytes()
            for mark in compile_cache._MARKS
        )
    ]
    assert ignored == []
