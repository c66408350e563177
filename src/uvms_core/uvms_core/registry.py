"""Doors: the parts of the system that can be replaced from outside, found by name.

A part is an entry point of an installed package, in the group of its kind, or `module:Name` for
one that has no entry. Nodes, in-process loop and command line all look here, so that a name means
the same everywhere. Nothing is imported before it is asked for.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any, TypeVar

from uvms_core.config import Config, PluginConfig, validated
from uvms_core.errors import PluginError

P = TypeVar("P", bound=PluginConfig)


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
    except (ImportError, AttributeError) as fault:
        raise PluginError(f"{door.what} {name!r}: cannot import {path}: {fault}") from fault
    return found


def create(door: Door, name: str, config: P, make: Callable[[Any, P], Any]) -> Any:
    """A part with its configuration.

    A class with an inner configuration `Parameters` finds `config.parameters` validated as such;
    one without takes no parameters.

    Args:
        door: kind of the part.
        name: entry point or `module:Class`.
        config: its section; `parameters` holds what only this part knows.
        make: calls the class, which is its first argument, with the configuration, its second.

    Raises:
        PluginError: the part cannot be found, or takes no parameters.
        ConfigError: its parameters are wrong; the message names field, value and bound.
    """
    cls = load(door, name)
    return make(cls, with_parameters(door, name, cls, config))


def with_parameters(door: Door, name: str, cls: Any, config: P) -> P:
    """The configuration with `parameters` as the part's own `Parameters`; raises as `create`."""
    model: type[Config] | None = getattr(cls, "Parameters", None)
    given = config.parameters
    if model is None:
        if given:
            unknown = ", ".join(sorted(given))
            raise PluginError(f"{door.what} {name!r} takes no parameters; got {unknown}")
        return config
    own = given if isinstance(given, model) else validated(model, given, f"parameters of {name}")
    return config.model_copy(update={"parameters": own})


def _is_path(name: str) -> bool:
    module, colon, attribute = name.partition(":")
    parts = [*module.split("."), *attribute.split(".")]
    return bool(colon) and all(part.isidentifier() for part in parts)


@cache
def _entries(group: str) -> dict[str, EntryPoint]:
    """Entry points of a group by name; of several of one name the first on the path counts."""
    found: dict[str, EntryPoint] = {}
    for entry in entry_points(group=group):
        found.setdefault(entry.name, entry)
    return found
