"""How a path is timed: from rest to rest, with a speed that is constant in between."""

from typing import Self

import numpy as np
from pydantic import Field, model_validator

from uvms_core.signals import Array
from uvms_planner.paths.shape import PathShape

USUAL_SHARE = 0.25
"""Of the duration, in which a path gets up to speed: the greatest speed is then 4/3 of the mean."""

POINTS_AN_EASE = 64
"""With which the acceleration while it gets up to speed is right within half a percent."""
MOST_POINTS = 10_000
"""For a spacing below the longest: a message with more of them has megabytes."""


class EasedShape(PathShape):
    """A path that gets up to speed smoothly, goes on at that speed, and stops as smoothly.

    The speed is V S(t / T_e), S(u) = 10 u^3 - 15 u^4 + 6 u^5, in the first T_e seconds and the same
    backwards in the last: acceleration and jerk-free rest at both ends, C2 in between.
    """

    ease_s: float | None = Field(
        None,
        gt=0,
        description="s, in which it gets up to its speed, and the same to stop; at most half of the"
        f" duration; none: {USUAL_SHARE:g} of the duration",
    )

    @model_validator(mode="after")
    def _has_time_to_ease(self) -> Self:
        if self.ease_s is not None and 2 * self.ease_s > self.seconds:
            raise ValueError(
                f"ease_s: {self.ease_s:g} s to get up to speed and the same to stop do not fit into"
                f" {self.seconds:g} s; give at most {self.seconds / 2:g} s"
            )
        return self

    @property
    def ease(self) -> float:
        """In which it gets up to speed, s."""
        return USUAL_SHARE * self.seconds if self.ease_s is None else self.ease_s

    @property
    def wanted_spacing_s(self) -> float:
        """Seconds between points that show the path's shape."""
        return self.ease / POINTS_AN_EASE

    @property
    def usual_spacing_s(self) -> float:
        """Seconds between the points of the path, where none are asked for."""
        shown = max(self.wanted_spacing_s, self.seconds / MOST_POINTS)
        return min(self.longest_spacing_s, shown)

    def progress(self, times: Array) -> Array:
        """Share (k,) of the way that is done at `times` (k,) s, from 0 to 1."""
        return eased(times, self.seconds, self.ease)


def eased(times: Array, duration: float, ease: float) -> Array:
    """Share (k,) of the way at `times` (k,), all in s: the integral of the speed above.

    With V = 1 / (duration - ease) the way at the end is 1, because S has the mean 1/2.
    """
    t = np.clip(times, 0.0, duration)
    first, last = _rise(np.minimum(t / ease, 1.0)), _rise(np.minimum((duration - t) / ease, 1.0))
    begun = ease * first + np.maximum(t - ease, 0.0)
    left = ease * last + np.maximum(duration - t - ease, 0.0)
    way = np.where(t < duration / 2, begun, duration - ease - left)
    return np.clip(way / (duration - ease), 0.0, 1.0)


def _rise(u: Array) -> Array:
    """The integral of S from 0 to u."""
    return u**4 * (2.5 - 3.0 * u + u**2)


def quintic(u: Array) -> Array:
    """10 u^3 - 15 u^4 + 6 u^5: from 0 to 1, with no speed and no acceleration at both ends."""
    return u**3 * (10 - 15 * u + 6 * u**2)
