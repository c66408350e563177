"""The samples of a line that a page shows: so few that it stays small, and no peak left out."""

import base64
import hashlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uvms_core.signals import Array

POINTS = 4000
"""Points of a line at most: more than a screen has columns."""
GAP = 8.0
"""Distances between samples that are so many times the usual one are a gap: no line there."""


def with_gaps(time: Array, values: Array) -> tuple[Array, Array]:
    """The line with a NaN in each gap, so that nothing is drawn where nothing was recorded."""
    if len(time) < 3:
        return time, values
    steps = np.diff(time)
    wide = np.flatnonzero(steps > GAP * float(np.median(steps)))
    middle = 0.5 * (time[wide] + time[wide + 1])
    return np.insert(time, wide + 1, middle), np.insert(values, wide + 1, np.nan)


def kept(values: Array, points: int = POINTS) -> NDArray[np.intp]:
    """Indices of at most `points` of the samples, in order.

    Of each stretch its least and its greatest, and its gap; the first and the last one stay. Every
    point is a sample as it was recorded, and no peak is lost.
    """
    count = len(values)
    if count <= points:
        return np.arange(count)
    begins = np.linspace(0, count, max((points - 2) // 3, 1) + 1).astype(int)[:-1]
    part = np.zeros(count, dtype=int)
    part[begins[1:]] = 1
    part = np.cumsum(part)
    missing = np.isnan(values)
    order = np.lexsort((np.where(missing, np.inf, values), part))
    least = order[begins]
    order = np.lexsort((np.where(missing, -np.inf, values), part))
    greatest = order[np.append(begins[1:], count) - 1]
    gaps = np.flatnonzero(missing)
    gaps = gaps[np.unique(part[gaps], return_index=True)[1]]
    index = np.concatenate([[0, count - 1], least, greatest, gaps])
    return np.unique(index)


def encoded(values: NDArray[Any], kind: str) -> str:
    """Numbers as base64 of little-endian bytes: `f4`, `f8`, `u2`, `u4` as numpy names them."""
    with np.errstate(over="ignore"):  # beyond 32 bits: infinite, which the page does not draw
        return base64.b64encode(np.asarray(values).astype(f"<{kind}").tobytes()).decode()


class Times:
    """The times of all lines of a page, each set of them once."""

    def __init__(self) -> None:
        self.encoded: list[str] = []
        self._numbers: dict[bytes, int] = {}

    def line(self, time: Array, values: Array) -> dict[str, Any]:
        """A line as the page has it: number of its times, which of them it has, its values."""
        time, values = with_gaps(time, values)
        index = kept(values)
        found = {"times": self._number(time), "values": encoded(values[index], "f4")}
        if len(index) == len(time):
            return found
        kind = "u2" if len(time) <= np.iinfo(np.uint16).max else "u4"
        return found | {"index": encoded(index, kind), "kind": kind}

    def _number(self, time: Array) -> int:
        key = hashlib.sha256(np.ascontiguousarray(time).tobytes()).digest()
        if key not in self._numbers:
            self._numbers[key] = len(self.encoded)
            self.encoded.append(encoded(time, "f8"))
        return self._numbers[key]
