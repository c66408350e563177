"""What the machine must have before anything is set up, and how to get what it lacks."""

import os
import platform
import re
import shutil
import subprocess
import sys
import sysconfig

SUPPORTED = ((3, 10), (3, 11), (3, 12), (3, 13))
PREFERENCE = ("python3.12", "python3.11", "python3.13", "python3.10")


class SetupError(Exception):
    """The set-up cannot go on; the text tells the user why and what to do."""


def supported_python(version=None):
    """Whether wheels exist for this version of Python."""
    return tuple(version or sys.version_info[:2]) in SUPPORTED


def other_python():
    """A supported Python on the PATH, or None."""
    return next(filter(None, map(shutil.which, PREFERENCE)), None)


def check():
    """Name everything that is missing at once, each with the way to get it."""
    faults = [fault for fault in (_system(), _python(), *_tools(), _venv(), _headers()) if fault]
    if faults:
        raise SetupError("\n".join("- " + fault for fault in faults))


def _system():
    if sys.platform == "linux" and platform.machine() in ("x86_64", "AMD64"):
        return None
    return (
        "ROS 2 wheels exist for Linux on x86-64 only, and this is %s on %s: use such a machine, "
        "a container of one, or a ROS 2 Jazzy workspace (`colcon build`)."
    ) % (platform.system(), platform.machine())


def _python():
    if supported_python():
        return None
    return (
        "Python 3.10, 3.11, 3.12 or 3.13 is needed and %s is %s: install one (`sudo apt install "
        "python3`, `brew install python@3.12`, `pyenv install 3.12`) and name it, as in "
        "`make run PYTHON=python3.12`."
    ) % (sys.executable, platform.python_version())


def _tools():
    if _cmake_version() < (3, 19):
        yield (
            "cmake 3.19 or newer is missing: `sudo apt install cmake`, `brew install cmake` "
            "or `pip install cmake`."
        )
    cxx = os.environ.get("CXX", "g++")
    if shutil.which(cxx) is None:
        yield (
            "a C++ compiler (%s) is missing: `sudo apt install g++`, `sudo dnf install gcc-c++` "
            "or `brew install gcc`."
        ) % cxx


def _cmake_version():
    if shutil.which("cmake") is None:
        return (0, 0)
    answer = subprocess.run(["cmake", "--version"], stdout=subprocess.PIPE, universal_newlines=True)
    found = re.search(r"version (\d+)\.(\d+)", answer.stdout)
    return tuple(map(int, found.groups())) if found else (0, 0)


def _venv():
    try:
        import ensurepip  # noqa: F401
        import venv  # noqa: F401
    except ImportError:
        return (
            "this Python has no venv module: `sudo apt install python3-venv` "
            "(python%d.%d-venv for a Python beside the system's)."
        ) % sys.version_info[:2]
    return None


def _headers():
    if os.path.exists(os.path.join(sysconfig.get_path("include"), "Python.h")):
        return None
    return (
        "the headers of this Python are missing: `sudo apt install python3-dev` "
        "(python%d.%d-dev for a Python beside the system's)."
    ) % sys.version_info[:2]
