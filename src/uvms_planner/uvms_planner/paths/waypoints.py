"""The word `waypoints`: a smooth curve through points, or straight from stop to stop."""

from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator
from scipy.spatial.transform import Rotation

from uvms_core.signals import Array
from uvms_planner.paths.shape import (
    AT_ORIGIN,
    LONGEST_PATH_S,
    Begin,
    Duration,
    Offset,
    PathPoints,
    PathShape,
)
from uvms_planner.paths.spline import dense_times, through, turned
from uvms_planner.paths.timing import quintic

Speed = Annotated[float, Field(gt=0.0, le=10.0)]
Turn = Annotated[float, Field(ge=-360.0, le=360.0)]


class Waypoints(PathShape):
    """Points one after the other, at given times or at given mean speeds.

    The curve is at rest at the start and at the last point; in between it does not stop, unless
    `stop` says so, and its acceleration is continuous.
    """

    points_m: tuple[Offset, ...] = Field(
        min_length=1,
        max_length=10_000,
        description="m, the points after the start, in the path's frame",
    )
    times_s: tuple[Duration, ...] | None = Field(
        None, description="s, when it passes each point, increasing; or give `speeds_m_s`"
    )
    speeds_m_s: Speed | tuple[Speed, ...] | None = Field(
        None,
        description="m/s, mean speed of the straight way to each point, one for all or one a point;"
        " or give `times_s`",
    )
    rpy_deg: tuple[tuple[Turn, Turn, Turn], ...] | None = Field(
        None,
        description="deg, roll, pitch and yaw of the tool at each point, in the path's frame: from"
        " its orientation at the start, or absolute; none: any orientation",
    )
    stop: bool = Field(False, description="stop at each point, with straight lines in between")

    @model_validator(mode="after")
    def _is_table(self) -> Self:
        if (self.times_s is None) == (self.speeds_m_s is None):
            got = "neither" if self.times_s is None else "both"
            raise ValueError(f"give either times_s or speeds_m_s; got {got}")
        for name in ("times_s", "speeds_m_s", "rpy_deg"):
            own = getattr(self, name)
            if isinstance(own, tuple) and len(own) != len(self.points_m):
                raise ValueError(f"{name}: {len(own)} values for {len(self.points_m)} points_m")
        if self.times_s is not None:  # no speeds need the start
            self.check_from(AT_ORIGIN)
        return self

    def check_from(self, begin: Begin) -> None:
        """Raise ValueError where a point takes no time, or all take too long."""
        times = self._times(begin)
        standing = np.flatnonzero(np.diff(times) <= 0.0)
        if len(standing):
            raise ValueError(self._standing_still(int(standing[0]), times))
        if times[-1] > LONGEST_PATH_S:
            raise ValueError(
                f"the path takes {times[-1]:g} s, may take at most {LONGEST_PATH_S:g} s"
            )

    def _standing_still(self, row: int, times: Array) -> str:
        if self.times_s is not None:
            return f"times_s: must be > 0 and increasing, are {_text(times[1:])}"
        return (
            f"points_m.{row}: is where the point before it is, so that its speed gives no time;"
            " leave it out, or give times_s"
        )

    @property
    def seconds(self) -> float:
        """To the last point, s; by speeds, from the origin of its frame."""
        return float(self._times(AT_ORIGIN)[-1])

    @property
    def oriented(self) -> bool:
        """Whether the points have orientations."""
        return self.rpy_deg is not None

    def _offsets(self, begin: Begin) -> Array:
        """The start and the points (n + 1, 3)."""
        return np.vstack([begin.position, np.array(self.points_m, dtype=float)])

    def _times(self, begin: Begin) -> Array:
        """When it is at the start and at each point (n + 1,), s."""
        if self.times_s is not None:
            return np.array([0.0, *self.times_s])
        lengths = np.linalg.norm(np.diff(self._offsets(begin), axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(lengths / np.array(self.speeds_m_s))])

    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """The curve at the points' own times and at times in between."""
        times, offsets = self._times(begin), self._offsets(begin)
        wanted = dense_times(times, spacing)
        between = _straight if self.stop else through
        turns = None
        if self.rpy_deg is not None:
            angles = np.array(self.rpy_deg, dtype=float)[:, ::-1]
            own = Rotation.from_euler("ZYX", angles, degrees=True)
            turns = turned(times, Rotation.concatenate([begin.rotation, own]), wanted)
        return PathPoints(wanted, between(times, offsets, wanted), turns)

    def scaled(self, factor: float) -> "Waypoints":
        """The points with their offsets times `factor`, passed at the same times."""
        times = self._times(AT_ORIGIN)[1:]
        points = tuple(tuple(factor * x for x in point) for point in self.points_m)
        return self.model_copy(
            update={"points_m": points, "times_s": tuple(times.tolist()), "speeds_m_s": None}
        )


def _straight(times: Array, points: Array, wanted: Array) -> Array:
    """From stop to stop on straight lines, (k, 3) at `wanted` (k,)."""
    index = np.clip(np.searchsorted(times, wanted, side="right") - 1, 0, len(times) - 2)
    share = quintic((wanted - times[index]) / (times[index + 1] - times[index]))[:, None]
    return (1 - share) * points[index] + share * points[index + 1]


def _text(values: Array) -> str:
    shown = ", ".join(f"{value:g}" for value in values[:10])
    return f"[{shown}{', ...' if len(values) > 10 else ''}]"
