"""Keep compiled kernels apart by the sources that they were made from.

numba looks at a function's own file to see whether its cached machine code is out of date, not at
the files of the kernels inlined into it: after an edit or an update a caller would silently go on
with its old callees. So the cache lies in a folder named after all kernels' sources. It is used
where the package's folder can be written to; elsewhere, and where NUMBA_CACHE_DIR is set, numba's
own rule holds.
"""

import hashlib
import importlib.util
import os
import shutil
import time
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numba

from uvms_core import registry

_MARKS = (b"numba", b"jit")
_KEPT_S = 7 * 24 * 3600.0  # folders of other sources, for whoever goes back to them


def fingerprint(folders: Iterable[Path]) -> str:
    """Hash of all Python files in these folders that mention numba or jit."""
    digest = hashlib.sha256()
    for folder in folders:
        for path in sorted(folder.rglob("*.py")):
            text = path.read_bytes()
            if any(mark in text for mark in _MARKS):
                digest.update(str(path.relative_to(folder)).encode() + text)
    return digest.hexdigest()[:16]


def use_own_cache() -> None:
    """Point numba to the folder of these sources; to be called before any kernel is defined."""
    parent = Path(__file__).parent / "__pycache__"
    config: Any = numba.config  # its settings come from the environment, unknown to mypy
    if config.CACHE_DIR or not os.access(parent if parent.exists() else parent.parent, os.W_OK):
        return
    current = parent / f"kernels-{fingerprint(_folders())}"
    config.CACHE_DIR = str(current)
    for folder in parent.glob("kernels-*"):
        if folder != current and time.time() - folder.stat().st_mtime > _KEPT_S:
            shutil.rmtree(folder, ignore_errors=True)


def _folders() -> Iterator[Path]:
    """Folders of the packages that have an entry in the group of those with kernels."""
    for name in registry.names(registry.KERNELS):
        spec = importlib.util.find_spec(name)
        for place in (spec.submodule_search_locations or ()) if spec else ():
            yield Path(place)


use_own_cache()
