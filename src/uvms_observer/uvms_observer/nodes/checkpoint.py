"""The estimate on disk, so that a navigation node that is started again goes on from it."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from uvms_core import checks
from uvms_core.errors import UvmsError
from uvms_core.signals import NANOSECONDS, Odometry

EVERY = NANOSECONDS
"""Time between two writes, ns of simulated time."""
LARGEST = 1_000_000
"""Bytes that are read of a file that calls itself a checkpoint; ours has three thousand."""


class Checkpoint:
    """One file; it is replaced as a whole, so that a reader never sees half of it.

    Args:
        path: of the file.
        run_id: of the run; an estimate of another run is none.
    """

    def __init__(self, path: Path, run_id: str) -> None:
        self._path, self._run_id = path, run_id
        self._written: int | None = None

    def write(self, estimate: Odometry) -> None:
        """Keep an estimate, unless the one before is not a second old.

        Raises:
            OSError: it cannot be written.
        """
        if self._written is not None and 0 <= estimate.stamp - self._written < EVERY:
            return
        self._written = estimate.stamp
        values = {name: getattr(estimate, name).ravel().tolist() for name in _SHAPES}
        text = json.dumps({"run_id": self._run_id, "stamp": estimate.stamp, **values})
        part = self._path.with_name(f".{self._path.name}.{os.getpid()}")
        part.write_text(text, encoding="utf-8")
        os.replace(part, self._path)

    def forget(self) -> None:
        """Nothing that was kept is to be gone on from.

        Raises:
            OSError: it cannot be removed.
        """
        self._written = None
        self._path.unlink(missing_ok=True)

    def read(self) -> Odometry | None:
        """The estimate of this run; None where there is none or it cannot be read."""
        try:
            with self._path.open("rb") as file:
                content: Any = json.loads(file.read(LARGEST))
            if content["run_id"] != self._run_id:
                return None
            arrays = {
                name: np.array(content[name], dtype=np.float64).reshape(shape)
                for name, shape in _SHAPES.items()
            }
            estimate = Odometry(int(content["stamp"]), **arrays)
            checks.check(str(self._path), estimate)
        except (OSError, ValueError, KeyError, TypeError, RecursionError, UvmsError):
            return None
        covariances = (estimate.pose_covariance, estimate.twist_covariance)
        return estimate if all(np.isfinite(each).all() for each in covariances) else None


_SHAPES: dict[str, tuple[int, ...]] = {
    "position": (3,),
    "quaternion": (4,),
    "nu": (6,),
    "pose_covariance": (6, 6),
    "twist_covariance": (6, 6),
}
