"""The word `line`: straight on."""

import numpy as np
from pydantic import Field

from uvms_planner.paths.shape import AT_ORIGIN, Begin, Duration, Offset, PathPoints, even_times
from uvms_planner.paths.timing import EasedShape


class Line(EasedShape):
    """A straight line from rest to rest."""

    to_m: Offset = Field(description="m, where it ends, in the path's frame")
    duration_s: Duration = Field(description="s, time that it takes")

    @property
    def seconds(self) -> float:
        """From the start to the end, s."""
        return self.duration_s

    def points(self, spacing: float, begin: Begin = AT_ORIGIN) -> PathPoints:
        """The share s of the way from the start to `to_m`."""
        times = even_times(self.duration_s, spacing)
        way = self.progress(times)[:, None]
        return PathPoints(times, (1.0 - way) * begin.position + way * np.array(self.to_m))

    def scaled(self, factor: float) -> "Line":
        """The line with its length times `factor`."""
        return self.model_copy(update={"to_m": tuple(factor * x for x in self.to_m)})
