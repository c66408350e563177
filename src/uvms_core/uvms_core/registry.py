"""Doors: the parts of the system that can be replaced from outside, found by name.

A part is an entry point of an installed package, in the group of its kind, or `module:Name` for
one that has no entry. Nodes, in-process loop and command line all look here, so that a name means
the same everywhere. Nothing is imported before it is asked for.
"""

from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, distributions
from typing import Any

from uvms_core.errors import PluginError


@dataclass(frozen=True)
class Door:
    """One kind of part: its group of entry points, and what one is called in messages."""

    group: str
    what: str


NODES = Door("uvms.nodes", "node")
NAVIGATION_FILTERS = Door("uvms.navigation_filters", "navigation filter")
OBSERVERS = Door("uvms.observers", "disturbance observer")
PLANNERS = Door("uvms.planners", "planner method")
CONTROLLERS = Door("uvms.controllers", "control law")
ALLOCATORS = Door("uvms.allocators", "allocation method")
SENSORS = Door("uvms.sensors", "sensor")
MEASUREMENTS = Door("uvms.measurements", "measurement")
COMMANDS = Door("uvms.commands", "command")
KERNELS = Door("uvms.kernels", "package with compiled kernels")

DOORS = (
    NODES,
    NAVIGATION_FILTERS,
    OBSERVERS,
    PLANNERS,
    CONTROLLERS,
    ALLOCATORS,
    SENSORS,
    MEASUREMENTS,
    COMMANDS,
    KERNELS,
)


def names(door: Door) -> tuple[str, ...]:
    """Names of all installed parts of a kind, sorted."""
    return tuple(sorted(_entries(door.group)))


def check(door: Door, name: str) -> str:
    """The name, if it is one that `load` can look up.

    Raises:
        PluginError: it is neither installed nor of the form `module:Name`; lists the choices.
    """
    if name not in _entries(door.group) and not _is_path(name):
        choices = ", ".join(names(door)) or "none is installed"
        raise PluginError(
            f"{door.what} {name!r} is unknown; choose one of {choices}, or name a class of your"
            " own as my_package.my_module:MyClass"
        )
    return name


def load(door: Door, name: str) -> Any:
    """The object behind a name.

    Raises:
        PluginError: the name is unknown, or its module or class cannot be imported; says why.
    """
    check(door, name)
    entry = _entries(door.group).get(name)
    path = name if entry is None else entry.value
    module, _, attribute = path.partition(":")
    try:
        found: Any = import_module(module)
        for part in attribute.split(".") if attribute else ():
            found = getattr(found, part)
    except Exception as fault:  # a module of the user's may raise anything
        raise PluginError(
            f"{door.what} {name!r}: cannot import {path}: {type(fault).__name__}: {fault}"
        ) from fault
    return found


def refresh() -> None:
    """Look at the installed packages again, after one has been installed in this process."""
    _all_entries.cache_clear()
    _entries.cache_clear()


def _is_path(name: str) -> bool:
    module, colon, attribute = name.partition(":")
    parts = [*module.split("."), *attribute.split(".")]
    return bool(colon) and all(part.isidentifier() for part in parts)


@cache
def _entries(group: str) -> dict[str, EntryPoint]:
    """Entry points of a group by name; of several of one name the first on the path counts."""
    found: dict[str, EntryPoint] = {}
    for entry in _all_entries():
        if entry.group == group:
            found.setdefault(entry.name, entry)
    return found


@cache
def _all_entries() -> tuple[EntryPoint, ...]:
    """Those of all installed packages, read once: that takes longer than all the rest."""
    return tuple(entry for package in distributions() for entry in package.entry_points)
