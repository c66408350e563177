"""Paths that a scenario file describes, from where the end effector is at the start or absolute."""

from typing import Any, Literal, Self

from pydantic import Field, model_validator

from uvms_core.config import Config
from uvms_core.signals import Array, PathGoal
from uvms_planner.path_frame import PathFrame, frame_of
from uvms_planner.path_orientation import Orientation, OrientationWord
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
from uvms_planner.paths.shape import AT_ORIGIN, Offset

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
    frame: PathFrame = Field(
        "start",
        description="of positions, directions and orientations: `start`, from the tool's position"
        " and orientation there, along the axes of map_ned; `map_ned`, absolute, north, east, down;"
        " `map`, absolute, east, north, up",
    )
    orientation: OrientationWord | None = Field(
        None,
        description="what the tool's orientation is to be: `free`; `keep`, as at the start; `axis`,"
        " only an axis of the tool along a direction; `full`, as the path has it. none: full where"
        " the path has orientations, otherwise free",
    )
    tool_axis: Offset | None = Field(
        None, description="with orientation `axis`: the axis, in the tool's own axes, of any length"
    )
    axis_along: Offset | None = Field(
        None,
        description="with orientation `axis`: where that axis points, in the frame's axes, of any"
        " length; none: where it points at the start",
    )
    keep_orientation: bool = Field(
        False,
        description="keep the tool's orientation of the start: the same as orientation `keep`",
    )
    time_scaling: Literal["none", "allowed"] = Field(
        "none",
        description="whether a path that is too fast for the limits may be followed slower, all of"
        " it by one factor: `none` or `allowed`",
    )
    time_scale_max: float = Field(
        10.0,
        ge=1.0,
        le=100.0,
        description="with time_scaling `allowed`: how many times as long the path may take",
    )
    point_every_s: float | None = Field(
        None,
        gt=0,
        le=60.0,
        description="s between the goal's points; none: 1 s of phases, 0.25 s of others and less"
        " where they are fast",
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
        if self.keep_orientation and self.orientation not in (None, "keep"):
            raise ValueError(f"keep_orientation: orientation is {self.orientation!r}; leave it out")
        if not self.absolute:
            self.shape.check_from(AT_ORIGIN)
        _ = self.wanted_orientation
        return self

    @property
    def shape(self) -> PathShape:
        """The path that the word describes."""
        if self.phases is not None:
            return PhasePath(phases=self.phases)
        return next(own for word in WORDS if (own := getattr(self, word)) is not None)

    @property
    def absolute(self) -> bool:
        """Whether its positions are absolute, so that its length depends on the start."""
        return self.frame != "start"

    @property
    def wanted_orientation(self) -> Orientation:
        """What the tool's orientation is to be. Raises ValueError where fields do not fit."""
        word = "keep" if self.keep_orientation else self.orientation
        return Orientation.of(word, self.tool_axis, self.axis_along, self.shape.oriented)

    @property
    def duration_s(self) -> float:
        """Seconds from the start to the end.

        With absolute waypoints by speeds it depends on the start: this is from the frame's origin.
        """
        return self.shape.seconds

    def points(self) -> PathPoints:
        """The path from the tool's pose at the start, in the frame `start`."""
        shape = self.shape
        return shape.points(self.point_every_s or shape.usual_spacing_s)

    def goal(self, position: Array, quaternion: Array) -> PathGoal:
        """The path as a goal from the tool's present `position` (3,) and `quaternion` (4,).

        Raises:
            ValueError: an absolute path that cannot begin there; names the field.
        """
        frame, shape = frame_of(self.frame, position, quaternion), self.shape
        shape.check_from(frame.begin)
        points = shape.points(self.point_every_s or shape.usual_spacing_s, frame.begin)
        orientations, axis, directions = self.wanted_orientation.along_path(
            frame, points, quaternion
        )
        return PathGoal(
            times=points.times,
            positions=frame.positions(points.offsets),
            orientations=orientations,
            tool_axis=axis,
            axis_directions=directions,
            time_scale_max=self.time_scale_max if self.time_scaling == "allowed" else 1.0,
        )

    def scaled(self, factor: float) -> "PathSpec":
        """The path with all its lengths times `factor`, and the same times.

        Raises:
            ValueError: its positions are absolute.
        """
        if factor == 1.0:
            return self
        if self.absolute:
            raise ValueError(f"frame: {self.frame} is absolute, such a path cannot be scaled")
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
