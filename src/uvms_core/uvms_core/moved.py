"""Old names keep working: a module's `__getattr__` hands them on, with a DeprecationWarning."""

import warnings
from collections.abc import Mapping
from importlib import import_module
from typing import Any


def moved(module: str, name: str, homes: Mapping[str, str]) -> Any:
    """What `name` of `module` has become; for a module's `__getattr__`.

    Args:
        module: `__name__` of the module that is asked.
        name: the attribute that it does not have.
        homes: by name, the module or package that has it now.

    Raises:
        AttributeError: the name never had its home there.
    """
    if name not in homes:
        raise AttributeError(f"module {module!r} has no attribute {name!r}")
    home = homes[name]
    warnings.warn(
        f"{module}.{name} has moved: import it from {home}", DeprecationWarning, stacklevel=3
    )
    found = import_module(home)
    if hasattr(found, name):
        return getattr(found, name)
    return import_module(f"{home}.{name}")
