"""The example clients as modules, as they stand in their folder."""

import sys
from importlib import import_module
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[2] / "examples/clients"


def imported(monkeypatch, name):
    """Yields the module `name` of the folder; nothing of the folder stays loaded."""
    monkeypatch.syspath_prepend(FOLDER)
    yield import_module(name)
    for each in FOLDER.glob("*.py"):
        sys.modules.pop(each.stem, None)
