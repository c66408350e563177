"""The words `circle` and `helix`: turns about an axis, through the end effector's start."""

from typing import Literal, Self

import numpy as np
from pydantic import Field, model_validator

from uvms_core.signals import Array
from uvms_planner.paths.shape import (
    AT_ORIGIN,
    FARTHEST_M,
    LONGEST_PATH_S,
    Begin,
    Duration,
    Length,
    Offset,
    PathPoints,
    even_times,
)
from uvms_planner.paths.timing import EasedShape

AXES = {"X": np.eye(3)[0], "Y": np.eye(3)[1], "Z": np.eye(3)[2]}
"""Of the path's frame: north, east, down, or of `map` east, north, up."""
MOST_TURNS = 1000.0
POINTS_A_TURN = 64
"""With which the acceleration of a turn is right within a thousandth."""
LEAST_SINE = 1e-3
"""Of the angle between normal and direction: below it the plane of the circle is not defined."""


class Circle(EasedShape):
    """A circle that passes through the end effector's start, once or several times.

    The angle is eased, so that every point lies on the circle whatever the speed is.
    """

    radius_m: float = Field(gt=0, le=FARTHEST_M, description="m, radius")
    plane: Literal["XOZ", "YOZ", "XOY"] | None = Field(
        None,
        description="plane of the frame's axes in which the circle lies, those of map_ned unless"
        " `frame` is map; it goes from the plane's first axis towards its second. none: given by"
        " `normal`",
    )
    normal: Offset | None = Field(
        None,
        description="normal of the circle's plane, in the frame's axes, of any length; it goes"
        " round it as a right-handed screw does. Instead of `plane`",
    )
    towards: Offset | None = Field(
        None,
        description="direction from the start to the circle's centre, in the frame's axes (its part"
        " in the plane counts); none: the plane's first axis, or with `normal` the axis X, Y or Z that is"
        " most nearly in the plane",
    )
    turns: float = Field(
        1.0,
        ge=-MOST_TURNS,
        le=MOST_TURNS,
        description="how often it goes round, in parts as well; negative: the other way round",
    )
    period_s: Duration | None = Field(
        None, description="s, mean time of a turn; or give `duration_s`"
    )
    duration_s: Duration | None = Field(
        None, description="s, time that all turns take; or give `period_s`"
    )

    @model_validator(mode="after")
    def _is_one_circle(self) -> Self:
        _exactly_one("plane", self.plane, "normal", self.normal)
        _exactly_one("period_s", self.period_s, "duration_s", self.duration_s)
        if self.turns == 0.0:
            raise ValueError("turns: must not be 0")
        if self.seconds > LONGEST_PATH_S:
            raise ValueError(
                f"period_s: {abs(self.turns):g} turns of {self.period_s:g} s take"
                f" {self.seconds:g} s; a path takes at most {LONGEST_PATH_S:g} s"
            )
        _ = self.axes()
        return self

    @property
    def seconds(self) -> float:
        """That all turns take, s."""
        return self.duration_s or abs(self.turns) * (self.period_s or 0.0)

    @property
    def wanted_spacing_s(self) -> float:
        """Where turns follow each other fast, the mean turn has `POINTS_A_TURN`."""
        return min(super().wanted_spacing_s, self.seconds / abs(self.turns) / POINTS_A_TURN)

    def axes(self) -> tuple[Array, Array, Array]:
        """Unit vectors (3,): from the start to the centre, that turned by 90 degrees, the normal.

        Raises ValueError where they are not defined.
        """
        normal, towards = self._normal_and_direction()
        length = float(np.linalg.norm(normal))
        if length == 0.0:
            raise ValueError("normal: must not be zero")
        normal = normal / length
        inside = towards - (towards @ normal) * normal
        if np.linalg.norm(inside) <= LEAST_SINE * np.linalg.norm(towards):
            raise ValueError(
                f"towards: {_text(towards)} has no part in the plane with the normal"
                f" {_text(normal)}"
            )
        inside = inside / np.linalg.norm(inside)
        return inside, np.cross(normal, inside), normal

    def _normal_and_direction(self) -> tuple[Array, Array]:
        if self.plane is not None:
            first, second = AXES[self.plane[0]], AXES[self.plane[2]]
            normal = np.cross(first, second)
        else:
            normal = np.array(self.normal, dtype=float)
            first = np.eye(3)[int(np.argmin(np.abs(normal)))]
        return normal, first if self.towards is None else np.array(self.towards, dtype=float)

    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """From the start r (1 - cos a) e1 - r sin a e2 at the angle a; e1 points to the centre."""
        times = even_times(self.seconds, spacing)
        to_centre, across, _ = self.axes()
        angle = 2 * np.pi * self.turns * self.progress(times)[:, None]
        offsets = (1 - np.cos(angle)) * to_centre - np.sin(angle) * across
        return PathPoints(times, begin.position + self.radius_m * offsets)

    def scaled(self, factor: float) -> Self:
        """The circle with its radius times `factor`."""
        return self.model_copy(update={"radius_m": factor * self.radius_m})


class Helix(Circle):
    """Turns as of a circle that go on along the normal of its plane as they go round."""

    advance_m: Length = Field(
        description="m along the normal, by each whole turn; negative: against it. The normal of"
        " XOZ is west, that of YOZ north, that of XOY down"
    )

    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """The circle's points, moved along the normal in proportion to the angle."""
        times, offsets, _ = super().points(spacing, begin)
        way = abs(self.turns) * self.progress(times)[:, None]
        return PathPoints(times, offsets + self.advance_m * way * self.axes()[2])

    def scaled(self, factor: float) -> Self:
        """The helix with radius and advance times `factor`."""
        own = super().scaled(factor)
        return own.model_copy(update={"advance_m": factor * self.advance_m})


def _exactly_one(first: str, one: object, second: str, other: object) -> None:
    if (one is None) == (other is None):
        got = "neither" if one is None else "both"
        raise ValueError(f"give either {first} or {second}; got {got}")


def _text(vector: Array) -> str:
    return f"[{', '.join(f'{x:g}' for x in vector)}]"
