"""The innovation gate of one sensor: rejects what is unlikely, but no sensor for ever.

A residual's squared Mahalanobis distance is chi-square distributed when the models of filter and
sensor are right. Beyond the gate a sample is rejected. If every sample is rejected for a long time,
the estimate is taken to be wrong: its covariance is multiplied by distance / gate, which puts the
residual at the gate, and the sample is used.
"""

from collections.abc import Callable
from typing import NamedTuple

from scipy.special import gammaincinv

from uvms_core.signals import to_nanoseconds


class Tally(NamedTuple):
    """Counts of one sensor's samples."""

    accepted: int = 0
    gated: int = 0  # rejected
    recovered: int = 0  # used after widening the covariance; also counted as accepted
    since: int | None = None  # ns, stamp of the last one used, or of the first one


class InnovationGate:
    """Gate of one sensor.

    Args:
        size: dimension of the measurement.
        probability: share of good samples that is accepted.
        timeout_s: how long all may be rejected, s.
    """

    def __init__(self, size: int, probability: float, timeout_s: float) -> None:
        # the chi-square quantile; scipy.stats has the same number and loads in a second
        self.limit = 2.0 * float(gammaincinv(0.5 * size, probability))
        self._timeout = to_nanoseconds(timeout_s)

    def apply(
        self,
        tally: Tally,
        stamp: int,
        correct: Callable[[float], float],
        widen: Callable[[float], None],
    ) -> Tally:
        """Correct within the gate; returns the new tally.

        Args:
            tally: of this sensor so far.
            stamp: of the sample, ns.
            correct: corrects the state if the distance is within its argument; returns it.
            widen: multiplies the state's covariance.
        """
        distance = correct(self.limit)
        accepted, gated, recovered, since = tally
        if distance <= self.limit:
            return Tally(accepted + 1, gated, recovered, stamp)
        if since is None or stamp - since < self._timeout:
            return Tally(accepted, gated + 1, recovered, stamp if since is None else since)
        widen(distance / self.limit)
        correct(float("inf"))
        return Tally(accepted + 1, gated, recovered + 1, stamp)
