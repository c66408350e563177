"""The package examples/my_sensor, installed apart, and a vehicle that has its sensor."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import yaml

from uvms_core.vehicle import dump_vehicle, load_vehicle

SOURCE = Path(__file__).resolve().parents[2] / "examples" / "my_sensor"
SECTION = {"rate_hz": 1.0, "position_m": [0.2, 0.1, -0.2], "noise_m": 0.1}


def installed(folder: Path) -> dict[str, str]:
    """Environment in which the package is installed, alone in a folder of its own."""
    source, target = folder / "source", folder / "site"
    shutil.copytree(SOURCE, source)
    command = [sys.executable, "-m", "pip", "install", "--no-deps", "--no-build-isolation"]
    command += ["--quiet", "--target", str(target), str(source)]
    subprocess.run(command, check=True, capture_output=True, text=True)
    paths = [str(target), *filter(None, [os.environ.get("PYTHONPATH")])]
    return dict(os.environ, PYTHONPATH=os.pathsep.join(paths))


def vehicle_file(folder: Path, dvl_noise: float, **sections: dict) -> Path:
    """The reference vehicle with a DVL of this noise, m/s, and further sections of sensors."""
    data = yaml.safe_load(dump_vehicle(load_vehicle()))
    data["sensors"]["dvl"]["noise_m_s"] = dvl_noise
    data["sensors"] |= sections
    path = folder / f"vehicle{len(sections)}.yaml"
    path.write_text(yaml.safe_dump(data), encoding="utf-8")
    return path


def uvms(environment: dict[str, str], *arguments: object) -> subprocess.CompletedProcess:
    """A command of `uvms` to its end."""
    command = [sys.executable, "-m", "uvms_bringup.cli", *map(str, arguments)]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=300.0, env=environment, check=False
    )
