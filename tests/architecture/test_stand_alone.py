"""Each package installs alone, without ROS, with what it requires and no more, and works."""

import os
import subprocess
import sys
from functools import cache
from importlib.metadata import Distribution, distribution
from pathlib import Path
from shutil import copytree, ignore_patterns

import numba
import pytest
from numba.core.caching import _CacheLocator
from packaging.requirements import Requirement
from project import PACKAGES, ROOT, required

from uvms_dynamics.kernels import compile_cache

EXAMPLES = {
    "uvms_core": "core_vehicle.py",
    "uvms_dynamics": "dynamics_own_chain.py",
    "uvms_observer": "observer_navigation.py",
    "uvms_planner": "planner_path.py",
    "uvms_control": "control_allocation.py",
    "uvms_analysis": "analysis_summary.py",
    "uvms_bringup": "bringup_simulate.py",
}
MADE = ignore_patterns("build", "*.egg-info", "__pycache__")
UNFINISHED = ignore_patterns("*.tmp.*")
"""What another process is writing into numba's cache at this moment."""

pytestmark = pytest.mark.slow


def run(command, cwd, **variables):
    done = subprocess.run(
        list(map(str, command)),
        cwd=cwd,
        env=os.environ | variables,
        capture_output=True,
        text=True,
        timeout=540,
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return done.stdout


def project_packages(package):
    """The package and those of the project that it requires, directly or not."""
    below = [project_packages(name) for name in required(package) if name in PACKAGES]
    return {package}.union(*below)


@cache
def libraries(name) -> frozenset[str]:
    """A distribution from the package index and all that it requires."""
    needed = [Requirement(line) for line in distribution(name).requires or []]
    used = [one.name for one in needed if one.marker is None or one.marker.evaluate({"extra": ""})]
    return frozenset({name}).union(*map(libraries, used))


def link(found: Distribution, site: Path) -> None:
    """Put the installed files of a distribution into another environment."""
    tops = {file.parts[0] for file in found.files or []} - {"..", "__pycache__"}
    for top in tops:
        place = site / top
        if not place.exists():
            place.symlink_to(Path(str(found.locate_file(top))).resolve())


def take_over_kernels(package: str, site: Path, cache: Path) -> None:
    """What was compiled of the project's sources serves their copies in an environment.

    Compiling all kernels again takes minutes. numba knows a source by its folder, time and size.
    """
    compile_cache.use_own_cache()
    ours = Path(numba.config.CACHE_DIR)
    for source in PACKAGES[package].rglob("*.py"):
        copy = site / source.relative_to(PACKAGES[package])
        if not copy.exists():  # setup.py
            continue
        status = source.stat()
        os.utime(copy, ns=(status.st_atime_ns, status.st_mtime_ns))
        compiled = ours / _CacheLocator.get_suitable_cache_subpath(str(source))
        if compiled.exists():
            theirs = cache / _CacheLocator.get_suitable_cache_subpath(str(copy))
            copytree(compiled, theirs, ignore=UNFINISHED, dirs_exist_ok=True)


class Environments:
    """A virtual environment for each package, without pip, ROS and the project's sources."""

    def __init__(self, place: Path) -> None:
        self._place = place
        self.variables = {"NUMBA_CACHE_DIR": str(place / "kernels")}
        self._wheels = place / "wheels"
        copies = [copytree(ROOT / folder, place / "source" / name, ignore=MADE)
                  for name, folder in PACKAGES.items()]  # fmt: skip
        command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--no-index"]
        run([*command, "--no-build-isolation", "--wheel-dir", self._wheels, *copies], place)

    def site(self, package: str) -> Path:
        """Where the packages of its environment are."""
        version = f"python{sys.version_info.major}.{sys.version_info.minor}"
        return self._place / package / "lib" / version / "site-packages"

    def make(self, package: str) -> Path:
        """The interpreter of the package's environment."""
        python = self._place / package / "bin" / "python"
        if python.exists():
            return python
        run([sys.executable, "-m", "venv", "--without-pip", self._place / package], self._place)
        pip = [sys.executable, "-m", "pip", "--python", python, "install", "--no-deps"]
        run(
            [*pip, "--no-index", "--no-compile", *self._wheels.glob(f"{package}-*.whl")],
            self._place,
        )
        below = project_packages(package)
        for name in set().union(*map(required, below)) - set(PACKAGES):
            for library in libraries(name):
                link(distribution(library), self.site(package))
        for name in below - {package}:
            self.make(name)
        # Not installed again, so that kernels are compiled once.
        take_over_kernels(package, self.site(package), self._place / "kernels")
        paths = [f"{self.site(name)}\n" for name in sorted(below - {package})]
        (self.site(package) / "below.pth").write_text("".join(paths))
        return python


@pytest.fixture(scope="module")
def environments(tmp_path_factory):
    return Environments(tmp_path_factory.mktemp("alone"))


@pytest.mark.parametrize(("package", "example"), EXAMPLES.items())
def test_package_runs_its_example_in_an_environment_of_its_own(
    environments, package, example, tmp_path
):
    python = environments.make(package)
    place = run([python, "-c", f"import {package}; print({package}.__file__)"], tmp_path)
    assert Path(place.strip()).is_relative_to(environments.site(package))
    answer = run([python, ROOT / "examples" / example], tmp_path, **environments.variables)
    assert len(answer.splitlines()) >= 2


def test_the_command_line_works_there(environments, tmp_path):
    program = environments.make("uvms_bringup").with_name("uvms")
    variables = environments.variables
    run(
        [program, "simulate", "hover", "--duration", "1", "--output", "hover"],
        tmp_path,
        **variables,
    )
    run([program, "report", "hover/run.mcap"], tmp_path, **variables)
    assert (tmp_path / "hover/report.html").is_file()


@pytest.mark.parametrize("name", ["rclpy", "uvms_msgs", "hypothesis", "uvms_control"])
def test_these_environments_lack_what_is_not_required(environments, name, tmp_path):
    python = environments.make("uvms_analysis")
    code = f"import importlib.util as util; print(util.find_spec({name!r}))"
    assert run([python, "-c", code], tmp_path).strip() == "None"
