"""The external package of `examples/my_package`, installed in a folder of the test's own."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2] / "examples" / "my_package"


def installed(folder: Path) -> Path:
    """Install the package as a user would, without the network; returns where it lies."""
    source, site = folder / "source", folder / "site"
    shutil.copytree(SOURCE, source, ignore=shutil.ignore_patterns("build", "*.egg-info"))
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    command += ["--no-deps", "--no-build-isolation", "--no-index", "--target", str(site)]
    subprocess.run([*command, str(source)], check=True, timeout=120)
    return site


def uvms(site: Path, *arguments: str) -> subprocess.CompletedProcess:
    """Run `uvms ...` in a process that finds the package."""
    environment = os.environ | {"PYTHONPATH": str(site)}
    return subprocess.run(
        [sys.executable, "-m", "uvms_bringup.cli", *arguments],
        capture_output=True,
        text=True,
        timeout=300,
        env=environment,
        check=False,
    )
