"""Where the tool was, is to go and should be: lines, and a ball at the target."""

from itertools import pairwise

import numpy as np

from uvms_bringup.viewer.elements import HIDDEN, Colour, Look, Node, Place, Places
from uvms_bringup.viewer.moment import Moment
from uvms_core.signals import Array

ASKED: Colour = (0.35, 0.40, 0.45)
TRAVELLED: Colour = (0.91, 0.35, 0.05)
PLANNED: Colour = (0.10, 0.65, 0.95)
TARGET: Colour = (0.95, 0.15, 0.60)
PIECES = 60
"""Of the travelled path, each of which appears when the tool has passed it: drawing the whole path
again in every frame would fill the shared file."""


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
        pairs = list(pairwise(marks))
        self._ends = {f"travelled_{n:02d}": times[last] for n, (_, last) in enumerate(pairs)}
        self._pieces = {
            f"travelled_{n:02d}": travelled[first : last + 1]
            for n, (first, last) in enumerate(pairs)
        }
        self.nodes = [self._line(name, TRAVELLED, at) for name, at in self._pieces.items()]
        if asked is not None:
            self.nodes.append(self._line("asked_path", ASKED, asked, 0.5))
        self.nodes.append(Node("planned_path", Look("line", PLANNED), HIDDEN))
        self.nodes.append(Node("trail", Look("line", TRAVELLED), HIDDEN))
        self.nodes.append(Node("target", Look("sphere", TARGET, 0.8), HIDDEN))

    def _line(self, name: str, colour: Colour, points: Array, opacity: float = 1.0) -> Node:
        return Node(name, Look("line", colour, opacity), Place(size=self._width, points=points))

    def places(self, moment: Moment) -> Places:
        """Which pieces are passed, the plan ahead and the target."""
        found: Places = {}
        for name, end in self._ends.items():
            passed = bool(end <= moment.time)
            found[name] = Place(size=self._width, visible=passed, points=self._pieces[name])
        target = moment.target
        found["planned_path"] = self._shown(moment.plan, 1.5)
        found["trail"] = self._shown(moment.trail, 1.0)
        found["target"] = HIDDEN if target is None else Place(target, size=2.5 * self._width)
        return found

    def _shown(self, points: Array | None, thickness: float) -> Place:
        if points is None or len(points) < 2:
            return HIDDEN
        return Place(size=thickness * self._width, points=points)
