"""Libraries that only the panel method needs."""

from importlib import import_module
from typing import Any

from uvms_dynamics.panel_method.errors import PanelMethodError


def optional(name: str) -> Any:
    """Module `name` of the extra `panels`; without it PanelMethodError says how to get it."""
    try:
        return import_module(name)
    except ImportError as fault:
        raise PanelMethodError(
            f"the panel method needs {name}, which is not installed. In the repository:"
            " .venv/bin/pip install capytaine trimesh -c requirements/constraints.txt"
            " (elsewhere the extra `panels` of the package uvms_dynamics)"
        ) from fault
