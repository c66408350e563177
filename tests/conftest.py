"""What tests run beside one another, where pytest-xdist runs them in several processes."""

from pathlib import Path

import pytest

HERE = Path(__file__).parent
ALONE = ("architecture", "faults", "integration", "ros")
"""Folders with graphs, environments and clocks: one of their tests at a time."""


@pytest.hookimpl(tryfirst=True)  # xdist reads the groups in the same hook
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """One group for the folders of `ALONE`; of the others each file, for the sake of fixtures."""
    for item in items:
        own = item.path.relative_to(HERE)
        group = "graphs" if own.parts[0] in ALONE else str(own)
        item.add_marker(pytest.mark.xdist_group(group))
