"""Straight from one configuration at rest to another, as fast as the limits allow."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_planner.limits import PEAK_BRAKING, MotionLimits
from uvms_planner.segment import Samples
from uvms_planner.timed_motion import TimedMotion

USUAL_RAMP = 0.25
"""Of the duration; the greatest speed is then 4/3 of the mean."""


@dataclass(frozen=True)
class Profile:
    """The share of a way over time: a speed that rises, stays, and falls as it has risen.

    It rises as 3 u^2 - 2 u^3, u = t / ramp, so that the acceleration is continuous and zero at both
    ends; its peak is `PEAK_BRAKING` times the mean.
    """

    duration: float  # s, >= 2 ramp
    ramp: float  # s

    @staticmethod
    def fastest(rate: float, acceleration: float) -> "Profile":
        """The shortest within a rate (1/s) and an acceleration (1/s^2) of the share."""
        rate = min(rate, float(np.sqrt(acceleration / PEAK_BRAKING)))
        ramp = PEAK_BRAKING * rate / acceleration
        return Profile(max(1.0 / rate + ramp, 2 * ramp), ramp)

    @staticmethod
    def lasting(duration: float, rate: float, acceleration: float) -> "Profile":
        """A profile of this duration within both, not shorter than the fastest.

        Its ramps are as near to `USUAL_RAMP` as the bounds allow: shorter ones take more
        acceleration, longer ones more speed.
        """
        inside = max(duration**2 - 4 * PEAK_BRAKING / acceleration, 0.0)
        least = 0.5 * (duration - np.sqrt(inside))  # of ramp (duration - ramp) acceleration = 1.5
        greatest = max(least, min(duration - 1.0 / rate, duration / 2))
        return Profile(duration, float(np.clip(USUAL_RAMP * duration, least, greatest)))

    @property
    def rate(self) -> float:
        """Greatest rate of the share, 1/s."""
        return 1.0 / (self.duration - self.ramp)

    @property
    def acceleration(self) -> float:
        """Greatest acceleration of the share, 1/s^2."""
        return PEAK_BRAKING * self.rate / self.ramp

    def slower(self, factor: float) -> "Profile":
        """The same in `factor` times the time."""
        return Profile(factor * self.duration, factor * self.ramp)

    def at(self, times: Array) -> tuple[Array, Array, Array]:
        """Share (k,) at `times` (k,) s, with two derivatives; before and after it rests."""
        t = np.clip(times, 0.0, self.duration)
        first, last = np.minimum(t / self.ramp, 1.0), np.minimum((self.duration - t) / self.ramp, 1)
        begun = self.ramp * _rise(first) + np.maximum(t - self.ramp, 0.0)
        left = self.ramp * _rise(last) + np.maximum(self.duration - t - self.ramp, 0.0)
        early = t < self.duration / 2
        share = np.where(early, self.rate * begun, 1.0 - self.rate * left)
        slope = 6.0 * np.where(early, first * (1 - first), -last * (1 - last))
        rising = np.minimum(first, last)
        return (
            share,
            self.rate * rising**2 * (3.0 - 2.0 * rising),
            self.rate / self.ramp * slope,
        )


def _rise(u: Array) -> Array:
    """The integral of 3 u^2 - 2 u^3 from 0 to u."""
    return u**3 * (1.0 - 0.5 * u)


def shares_of_limits(way: Array, limits: MotionLimits) -> tuple[float, float]:
    """Rate (1/s) and acceleration (1/s^2) at which a way (m,) may be gone, all of it at once.

    In the plane the length counts, whatever the heading. Infinite where there is no way.
    """
    plane = np.hypot(way[0], way[1])
    distances = np.concatenate([[plane], np.abs(way[2:])])

    def least(bounds: Array) -> float:
        allowed = np.concatenate([[min(bounds[0], bounds[1])], bounds[2:]])
        share = np.max(distances / allowed)
        return np.inf if share == 0.0 else 1.0 / float(share)

    return least(limits.rate), least(limits.acceleration)


class StraightMotion(TimedMotion):
    """From rest to rest, all variables along one profile, and then a time of staying there."""

    def __init__(
        self,
        ends: tuple[Array, Array],
        profile: Profile | None,
        start: int,
        step: float,
        hold: float = 0.0,
    ) -> None:
        """`ends` are configurations (m,); no profile: they are the same. `hold` in s."""
        super().__init__(start, step)
        self.ends, self.profile, self._hold = ends, profile, hold

    def along(self, profile: Profile) -> "StraightMotion":
        """The same way by another profile."""
        return StraightMotion(self.ends, profile, self._start, self._step, self._hold)

    @property
    def duration(self) -> float:
        """Seconds that the motion takes, with the time of staying there."""
        return self._hold + (0.0 if self.profile is None else self.profile.duration)

    def sample(self, times: Array) -> Samples:
        """As of TimedMotion."""
        first, last = self.ends
        if self.profile is None:
            still = np.zeros((len(times), len(first)))
            return Samples(still + last, still, still)
        share, rate, acceleration = (part[:, None] for part in self.profile.at(np.asarray(times)))
        way = last - first
        configuration = np.where(share < 0.5, first + share * way, last - (1.0 - share) * way)
        return Samples(configuration, rate * way, acceleration * way)
