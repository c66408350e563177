"""Where scenarios and campaigns are: the source tree first, then the installed share folders."""

import os
import sys
from collections.abc import Iterator
from pathlib import Path

from uvms_bringup.errors import ScenarioError

_CONFIG = Path("config")
_SHARE = Path("share") / "uvms_bringup"


def scenario_folder() -> Path:
    """Folder of the scenarios that come with the project; ScenarioError lists where it looked."""
    return _folder("scenarios")


def known_scenarios() -> dict[str, Path]:
    """Scenarios that come with the project, by name."""
    return _files("scenarios")


def known_campaigns() -> dict[str, Path]:
    """Campaigns that come with the project, by name."""
    return _files("campaigns")


def _files(kind: str) -> dict[str, Path]:
    return {path.stem: path for path in sorted(_folder(kind).glob("*.yaml"))}


def _folder(kind: str) -> Path:
    looked = [place / kind for place in _candidates()]
    for path in looked:
        if path.is_dir():
            return path
    places = "\n".join(f"  {path}" for path in looked)
    raise ScenarioError(f"the project's {kind} were not found; looked for\n{places}")


def _candidates() -> Iterator[Path]:
    yield Path(__file__).resolve().parents[1] / _CONFIG
    for prefix in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        yield Path(prefix) / _SHARE / _CONFIG
    yield Path(sys.prefix) / _SHARE / _CONFIG
