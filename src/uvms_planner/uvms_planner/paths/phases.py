"""The word `phases`: straight or bulging ways, each from rest to rest, as in the paper's Fig. 9."""

from typing import ClassVar

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.signals import Array
from uvms_planner.paths.shape import (
    AT_ORIGIN,
    Begin,
    Duration,
    Offset,
    PathPoints,
    PathShape,
    even_times,
)
from uvms_planner.paths.timing import quintic


class PathPhase(Config):
    """One phase of a path, from rest to rest."""

    duration_s: Duration = Field(300.0, description="s, time that it takes")
    to_m: Offset = Field((0.0, 0.0, 0.0), description="m, where it ends, in the path's frame")
    bulge_m: Offset = Field(
        (0.0, 0.0, 0.0), description="m, offset of the halfway point from the straight line"
    )


class PhasePath(PathShape):
    """Phases one after the other."""

    longest_spacing_s: ClassVar[float] = 1.0

    phases: tuple[PathPhase, ...] = Field(min_length=1, description="the phases, in order")

    @property
    def seconds(self) -> float:
        """That all phases take, s."""
        return sum(phase.duration_s for phase in self.phases)

    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """Every phase at evenly spaced times, its end among them."""
        times, offsets = [np.zeros(1)], [begin.position[None]]
        for phase in self.phases:
            inside = even_times(phase.duration_s, spacing)[1:]
            offsets.append(_phase_points(offsets[-1][-1], phase, inside))
            times.append(times[-1][-1] + inside)
        return PathPoints(np.concatenate(times), np.concatenate(offsets))

    def scaled(self, factor: float) -> "PhasePath":
        """The phases with all lengths times `factor`."""
        phases = tuple(
            phase.model_copy(
                update={
                    "to_m": tuple(factor * x for x in phase.to_m),
                    "bulge_m": tuple(factor * x for x in phase.bulge_m),
                }
            )
            for phase in self.phases
        )
        return self.model_copy(update={"phases": phases})


def _phase_points(start: Array, phase: PathPhase, times: Array) -> Array:
    """Straight line plus a parabola that is `bulge_m` half-way, under quintic time scaling.

    p(s) = start + s (end - start) + 4 s (1 - s) bulge, s = 10 u^3 - 15 u^4 + 6 u^5, u = t / T;
    velocity and acceleration are zero at both ends because those of s are.
    """
    s = quintic((times / phase.duration_s)[:, None])
    end, bulge = np.array(phase.to_m), np.array(phase.bulge_m)
    return start + s * (end - start) + 4 * s * (1 - s) * bulge
