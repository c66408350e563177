"""Find the reference vehicle's file: the source tree first, then the installed share folders."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

from uvms_dynamics.errors import VehicleFileError

REFERENCE = "reference_auv.yaml"
_SHARE = Path("share") / "uvms_bringup" / "config"


def reference_file() -> Path:
    """Path of the reference vehicle's file; raises VehicleFileError that lists where it looked."""
    looked = list(_candidates())
    for path in looked:
        if path.is_file():
            return path
    places = "\n".join(f"  {path}" for path in looked)
    raise VehicleFileError(f"the reference vehicle's file was not found; looked for\n{places}")


def _candidates() -> Iterator[Path]:
    here = Path(__file__).resolve()
    if here.parts[-5:-1] == ("src", "uvms_dynamics", "uvms_dynamics", "vehicle"):
        yield here.parents[4] / "bringup" / "config" / REFERENCE
    for prefix in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(prefix) / _SHARE / REFERENCE
    yield Path(sys.prefix) / _SHARE / REFERENCE
