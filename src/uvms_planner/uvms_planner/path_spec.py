"""Paths that a scenario file describes relative to where the end effector is at the start."""

from typing import Any, Self

import numpy as np
from pydantic import Field, model_validator
from scipy.spatial.transform import Rotation

from uvms_core.config import Config
from uvms_core.signals import Array, PathGoal
from uvms_planner.paths import (
    Circle,
    CsvPath,
    Helix,
    Line,
    PathPhase,
    PathPoints,
    PathShape,
    PhasePath,
    Waypoints,
)

__all__ = ["WORDS", "PathPhase", "PathSpec", "figure_9"]

WORDS = ("phases", "line", "circle", "helix", "waypoints", "csv")
"""What a path may be."""


class PathSpec(Config):
    """A path of the end effector by one of several words, from rest to rest."""

    phases: tuple[PathPhase, ...] | None = Field(
        None, min_length=1, description="phases in order, each from rest to rest"
    )
    line: Line | None = Field(None, description="a straight line")
    circle: Circle | None = Field(None, description="a circle through the start")
    helix: Helix | None = Field(None, description="turns that go on along their axis")
    waypoints: Waypoints | None = Field(None, description="a smooth curve through points")
    csv: CsvPath | None = Field(
        None, description="a table of times and positions: the name of a CSV file, or the section"
    )
    point_every_s: float | None = Field(
        None,
        gt=0,
        le=60.0,
        description="s between the goal's points; none: 1 s of phases, 0.25 s of others",
    )
    keep_orientation: bool = Field(
        False, description="keep the tool's orientation of the start along the whole path"
    )

    @model_validator(mode="after")
    def _is_one_path(self) -> Self:
        given = [word for word in WORDS if getattr(self, word) is not None]
        if len(given) != 1:
            raise ValueError(
                f"a path is one of {', '.join(WORDS)}; got {' and '.join(given) or 'none'}"
            )
        if self.keep_orientation and self.shape.oriented:
            raise ValueError(
                f"keep_orientation: {given[0]} has orientations of its own; leave out one of them"
            )
        return self

    @property
    def shape(self) -> PathShape:
        """The path that the word describes."""
        if self.phases is not None:
            return PhasePath(phases=self.phases)
        return next(own for word in WORDS if (own := getattr(self, word)) is not None)

    @property
    def duration_s(self) -> float:
        """Seconds from the start to the end."""
        return self.shape.seconds

    def points(self) -> PathPoints:
        """The path from the tool's pose at the start."""
        shape = self.shape
        return shape.points(self.point_every_s or shape.usual_spacing_s)

    def goal(self, position: Array, quaternion: Array) -> PathGoal:
        """The path as a goal from the tool's present `position` (3,) and `quaternion` (4,)."""
        times, offsets, turns = self.points()
        start = np.asarray(quaternion, dtype=float)
        orientations = np.zeros((0, 4))
        if turns is not None:
            orientations = (Rotation.from_quat(start) * Rotation.from_quat(turns)).as_quat()
        elif self.keep_orientation:
            orientations = np.tile(start, (len(times), 1))
        return PathGoal(times, np.asarray(position, dtype=float) + offsets, orientations)

    def scaled(self, factor: float) -> "PathSpec":
        """The path with all its lengths times `factor`, and the same times."""
        own: Any = self.shape.scaled(factor)
        word = next(word for word in WORDS if getattr(self, word) is not None)
        value = own.phases if isinstance(own, PhasePath) else own
        return self.model_copy(update={word: value})


def figure_9() -> PathSpec:
    """The manipulation of the paper's Fig. 9, with sizes chosen here (the figure gives none).

    300 s down; 300 s up in the XOZ plane; 300 s up in the YOZ plane and back to the start.
    """
    return PathSpec(
        phases=(
            PathPhase(duration_s=300.0, to_m=(0.0, 0.0, 0.35)),
            PathPhase(duration_s=300.0, to_m=(0.0, 0.0, 0.15), bulge_m=(0.1, 0.0, 0.0)),
            PathPhase(duration_s=300.0, to_m=(0.0, 0.0, 0.0), bulge_m=(0.0, 0.1, 0.0)),
        )
    )
