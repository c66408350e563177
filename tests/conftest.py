"""What tests run beside one another in several processes, and what they keep to themselves."""

import os
import shutil
import tempfile
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).parent
ALONE = ("faults", "ros")
"""Folders with graphs and clocks: one of their tests at a time."""
BUILDS = ("ros/test_colcon.py",)
"""Files in them that only build and install: these go beside the graphs."""
FONTS = "MPLCONFIGDIR"
"""matplotlib's folder: a list of fonts that another program left broken shows on stderr."""


def pytest_configure(config: pytest.Config) -> None:
    """Give matplotlib a folder of this session's own; workers take over that of their master."""
    if FONTS not in os.environ:
        folder = tempfile.mkdtemp(prefix="uvms_matplotlib_")
        os.environ[FONTS] = folder
        config.add_cleanup(lambda: shutil.rmtree(folder, ignore_errors=True))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Several processes take groups of tests (`group`), so that each fixture is made once.

    Marks of xdist's own groups are without effect from pytest 9.2 on.
    """
    from xdist.scheduler import LoadScopeScheduling

    class Groups(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return group(nodeid)

    return Groups(config, log)


def group(nodeid: str) -> str:
    """All tests of the folders of `ALONE`; of the rest each file."""
    file = nodeid.split("::")[0].removeprefix(f"{HERE.name}/")
    is_alone = file.split("/")[0] in ALONE and file not in BUILDS
    return "graphs" if is_alone else file
