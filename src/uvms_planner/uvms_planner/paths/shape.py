"""What every word of a path has in common: how long it takes, its points, and a scaled copy."""

from abc import abstractmethod
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.signals import Array

LONGEST_PATH_S = 86400.0
"""s; a day. Longer work is made of several goals."""
FARTHEST_M = 1000.0
"""m from the start; beyond it a path is a transit of the vehicle and no work of its arm."""

Length = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M)]
Offset = tuple[Length, Length, Length]
"""m, from the end effector's start, along the axes of map_ned."""
Duration = Annotated[float, Field(gt=0.0, le=LONGEST_PATH_S)]


class PathPoints(NamedTuple):
    """A path from the tool's pose at its start, at k times."""

    times: Array  # (k,) s, from 0
    offsets: Array  # (k, 3) m, from the tool's start, map_ned axes
    turns: Array | None = None  # (k, 4) quaternions, tool to its orientation at the start


class PathShape(Config):
    """One word of `goal.path`."""

    usual_spacing_s: ClassVar[float] = 0.25
    """s between the points of a curve: the planner's cubic segments between the points of a circle
    that turns once a minute then stay within 2e-5 of its radius."""

    @property
    @abstractmethod
    def seconds(self) -> float:
        """From the first point to the last, s."""

    @property
    def oriented(self) -> bool:
        """Whether it has orientations of its own."""
        return False

    @abstractmethod
    def points(self, spacing: float) -> PathPoints:
        """The path at points that are at most `spacing` s apart."""

    @abstractmethod
    def scaled(self, factor: float) -> "PathShape":
        """The same with all lengths times `factor`, and the same times."""


def even_times(duration: float, spacing: float) -> Array:
    """Times (k,) from 0 to `duration`, s, evenly spaced, with at least one in between."""
    count = max(2, int(np.ceil(duration / spacing)))
    return np.linspace(0.0, duration, count + 1)
