"""Compiled kernels are kept apart by the sources that they were made from."""

import os
import subprocess
import sys

import pytest

from uvms_dynamics import compile_cache
from uvms_dynamics.compile_cache import fingerprint


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
