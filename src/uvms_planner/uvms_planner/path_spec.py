"""Paths that a scenario file describes relative to where the end effector is at the start."""

from typing import Annotated

import numpy as np
from pydantic import Field

from uvms_core.config import Config
from uvms_core.signals import Array, PathGoal

Vector3 = Annotated[tuple[float, ...], Field(min_length=3, max_length=3)]


class PathPhase(Config):
    """One phase of a path, from rest to rest."""

    duration_s: float = Field(300.0, gt=0, le=86400.0, description="s, time that it takes")
    to_m: Vector3 = Field(
        (0.0, 0.0, 0.0), description="m, where it ends, from the start point, map_ned axes"
    )
    bulge_m: Vector3 = Field(
        (0.0, 0.0, 0.0), description="m, offset of the halfway point from the straight line"
    )


class PathSpec(Config):
    """A path of the end effector in phases, each from rest to rest."""

    phases: tuple[PathPhase, ...] = Field(
        (PathPhase(),), min_length=1, description="the phases, in order"
    )
    point_every_s: float = Field(1.0, gt=0, le=60.0, description="s between the goal's points")
    keep_orientation: bool = Field(
        False, description="keep the tool's orientation of the start along the whole path"
    )

    @property
    def duration_s(self) -> float:
        """Seconds that all phases take."""
        return sum(phase.duration_s for phase in self.phases)

    def goal(self, position: Array, quaternion: Array) -> PathGoal:
        """The path as a goal from the tool's present `position` (3,) and `quaternion` (4,)."""
        times, offsets = [np.zeros(1)], [np.zeros((1, 3))]
        for phase in self.phases:
            inside = _times_of(phase.duration_s, self.point_every_s)
            offsets.append(_phase_points(offsets[-1][-1], phase, inside))
            times.append(times[-1][-1] + inside)
        all_times = np.concatenate(times)
        turns = len(all_times) if self.keep_orientation else 0
        return PathGoal(
            times=all_times,
            positions=np.asarray(position, dtype=float) + np.concatenate(offsets),
            orientations=np.tile(np.asarray(quaternion, dtype=float), (turns, 1)).reshape(-1, 4),
        )


def _times_of(duration: float, spacing: float) -> Array:
    count = max(2, int(np.ceil(duration / spacing)))
    return np.linspace(0.0, duration, count + 1)[1:]


def _phase_points(start: Array, phase: PathPhase, times: Array) -> Array:
    """Straight line plus a parabola that is `bulge_m` half-way, under quintic time scaling.

    p(s) = start + s (end - start) + 4 s (1 - s) bulge, s = 10 u^3 - 15 u^4 + 6 u^5, u = t / T;
    velocity and acceleration are zero at both ends because those of s are.
    """
    u = (times / phase.duration_s)[:, None]
    s = u**3 * (10 - 15 * u + 6 * u**2)
    end, bulge = np.array(phase.to_m), np.array(phase.bulge_m)
    return start + s * (end - start) + 4 * s * (1 - s) * bulge


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
