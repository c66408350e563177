"""Every part that the packages register can be loaded, and is what its group promises."""

import inspect

import pytest

from uvms_core import registry, topics
from uvms_core.command import Command

ENTRIES = [(door, name) for door in registry.DOORS for name in registry.names(door)]


@pytest.mark.parametrize(("door", "name"), ENTRIES, ids=lambda item: getattr(item, "group", item))
def test_entry_can_be_loaded(door, name):
    found = registry.load(door, name)
    if door is registry.COMMANDS:
        assert isinstance(found, Command)
        assert found.help
    elif door is registry.KERNELS:
        assert inspect.ismodule(found)
    else:
        assert callable(found)


def test_every_node_of_the_graph_is_registered():
    assert set(topics.NODES) <= set(registry.names(registry.NODES))
