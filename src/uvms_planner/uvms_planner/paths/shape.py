"""What every word of a path has in common: how long it takes, its points, and a scaled copy."""

from abc import abstractmethod
from typing import Annotated, ClassVar, NamedTuple

import numpy as np
from pydantic import Field
from scipy.spatial.transform import Rotation

from uvms_core.config import Config
from uvms_core.signals import Array

LONGEST_PATH_S = 86400.0
"""s; a day. Longer work is made of several goals."""
FARTHEST_M = 1000.0
"""m from the start; beyond it a path is a transit of the vehicle and no work of its arm."""

Length = Annotated[float, Field(ge=-FARTHEST_M, le=FARTHEST_M)]
Offset = tuple[Length, Length, Length]
"""m, in the path's frame: from the end effector's start along the axes of map_ned, or absolute."""
Duration = Annotated[float, Field(gt=0.0, le=LONGEST_PATH_S)]


class Begin(NamedTuple):
    """The tool's pose at the start, in the path's frame."""

    position: Array  # (3,) m
    rotation: Rotation  # tool to frame


AT_ORIGIN = Begin(np.zeros(3), Rotation.identity())
"""Where a path begins whose frame is the start: with that position and orientation as its zero."""


class PathPoints(NamedTuple):
    """A path in its frame, at k times. In the frame `start` its zero is the tool's pose there."""

    times: Array  # (k,) s, from 0
    offsets: Array  # (k, 3) m, from the origin of the frame
    turns: Array | None = None  # (k, 4) quaternions, tool to frame


class PathShape(Config):
    """One word of `goal.path`."""

    longest_spacing_s: ClassVar[float] = 0.25
    """s between the points of a curve."""

    @property
    def usual_spacing_s(self) -> float:
        """Seconds between the points of the path, where none are asked for."""
        return self.longest_spacing_s

    @property
    @abstractmethod
    def seconds(self) -> float:
        """From the first point to the last, s."""

    def check_from(self, begin: Begin) -> None:
        """Raise ValueError, with the field, where it cannot begin there."""

    @property
    def oriented(self) -> bool:
        """Whether it has orientations of its own."""
        return False

    @abstractmethod
    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """The path from `begin` at points that are at most `spacing` s apart."""

    @abstractmethod
    def scaled(self, factor: float) -> "PathShape":
        """The same with all lengths times `factor`, and the same times."""


def even_times(duration: float, spacing: float) -> Array:
    """Times (k,) from 0 to `duration`, s, evenly spaced, with at least one in between."""
    count = max(2, int(np.ceil(duration / spacing)))
    return np.linspace(0.0, duration, count + 1)
