"""What tests run beside one another in several processes, and what they keep to themselves."""

import os
import shutil
import tempfile
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ALONE = ("faults", "integration", "ros")
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


@pytest.hookimpl(tryfirst=True)  # xdist reads the groups in the same hook
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """One group for the folders of `ALONE`; of the rest each file, for the sake of fixtures."""
    for item in items:
        own = item.path.relative_to(HERE)
        is_alone = own.parts[0] in ALONE and own.as_posix() not in BUILDS
        group = "graphs" if is_alone else str(own)
        item.add_marker(pytest.mark.xdist_group(group))
