"""The word `line`: straight on."""

import numpy as np
from pydantic import Field

from uvms_planner.paths.shape import Duration, Offset, PathPoints, even_times
from uvms_planner.paths.timing import EasedShape


class Line(EasedShape):
    """A straight line from rest to rest."""

    to_m: Offset = Field(description="m, where it ends, from the start point, map_ned axes")
    duration_s: Duration = Field(description="s, time that it takes")

    @property
    def seconds(self) -> float:
        """From the start to the end, s."""
        return self.duration_s

    def points(self, spacing: float) -> PathPoints:
        """Offset s to_m at the share s of the way."""
        times = even_times(self.duration_s, spacing)
        return PathPoints(times, self.progress(times)[:, None] * np.array(self.to_m))

    def scaled(self, factor: float) -> "Line":
        """The line with its length times `factor`."""
        return self.model_copy(update={"to_m": tuple(factor * x for x in self.to_m)})
