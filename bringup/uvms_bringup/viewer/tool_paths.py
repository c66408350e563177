"""Where the tool was, is to go and should be: lines, and a ball at the target."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from uvms_bringup.viewer.elements import HIDDEN, Colour, Look, Node, Place, Places
from uvms_bringup.viewer.moment import Moment
from uvms_core.signals import Array

ASKED: Colour = (0.35, 0.40, 0.45)
TRAVELLED: Colour = (0.91, 0.35, 0.05)
PLANNED: Colour = (0.10, 0.65, 0.95)
TARGET: Colour = (0.95, 0.15, 0.60)
PIECES = 64
"""Of the travelled path, each of which appears when the tool has passed it: drawing the whole path
again in every frame would fill the shared file. Whole pairs of pieces are one line, pairs of these
again, and so on, so that few lines are drawn at a time."""


class ToolPaths:
    """Lines of the tool in map_ned.

    Args:
        times: (k,) s, when the tool was where; increasing.
        travelled: (k, 3) m, its places over the whole run; (0, 3) where nothing is known yet.
        asked: (j, 3) m, the path of the goal; None without one.
        width: of the lines, m.
    """

    def __init__(self, times: Array, travelled: Array, asked: Array | None, width: float) -> None:
        self._width = np.full(3, width)
        marks = np.unique(np.linspace(0, max(len(times) - 1, 0), PIECES + 1).astype(int))
        self._ends = times[marks[1:]]
        self._pieces = {
            _name(first, last): Place(
                size=self._width, points=travelled[marks[first] : marks[last] + 1]
            )
            for first, last in blocks(len(self._ends))
        }
        self._hidden = {name: replace(at, visible=False) for name, at in self._pieces.items()}
        self.nodes = [Node(name, Look("line", TRAVELLED), at) for name, at in self._hidden.items()]
        if asked is not None:
            self.nodes.append(self._line("asked_path", ASKED, asked, 0.5))
        self.nodes.append(Node("planned_path", Look("line", PLANNED), HIDDEN))
        self.nodes.append(Node("trail", Look("line", TRAVELLED), HIDDEN))
        self.nodes.append(Node("target", Look("sphere", TARGET, 0.8), HIDDEN))

    def _line(self, name: str, colour: Colour, points: Array, opacity: float = 1.0) -> Node:
        return Node(name, Look("line", colour, opacity), Place(size=self._width, points=points))

    def places(self, moment: Moment) -> Places:
        """Which pieces are passed, the plan ahead and the target."""
        passed = int(np.searchsorted(self._ends, moment.time, side="right"))
        shown = {_name(first, last) for first, last in cover(passed)}
        found = self._hidden | {name: self._pieces[name] for name in shown}
        target = moment.target
        found["planned_path"] = self._shown(moment.plan, 1.5)
        found["trail"] = self._shown(moment.trail, 1.0)
        found["target"] = HIDDEN if target is None else Place(target, size=2.5 * self._width)
        return found

    def _shown(self, points: Array | None, thickness: float) -> Place:
        if points is None or len(points) < 2:
            return HIDDEN
        return Place(size=thickness * self._width, points=points)


def blocks(count: int) -> Iterator[tuple[int, int]]:
    """All that `cover` needs for any number of pieces up to a count: first piece and end."""
    size = 1
    while size <= count:
        yield from ((first, first + size) for first in range(0, count - size + 1, size))
        size *= 2


def cover(passed: int) -> Iterator[tuple[int, int]]:
    """The fewest blocks that are the first so many pieces: one for each 1 of the binary number."""
    first = 0
    for power in reversed(range(passed.bit_length())):
        if passed & (size := 1 << power):
            yield first, first + size
            first += size


def _name(first: int, last: int) -> str:
    return f"travelled_{first:02d}_{last:02d}"
