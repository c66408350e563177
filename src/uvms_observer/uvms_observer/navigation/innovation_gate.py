"""The innovation gate of one sensor: lets in what is likely, counts, and never locks out for good.

A residual's squared Mahalanobis distance is chi-square distributed when filter and sensor are
sound. Beyond the gate a sample is kept out. But if every sample is kept out for a long time, it is
the filter that is wrong: then its covariance is widened by distance / gate, which makes the
residual just likely, and the sample is taken.
"""

from collections.abc import Callable
from typing import NamedTuple

from scipy.stats import chi2

from uvms_core.signals import to_nanoseconds


class Tally(NamedTuple):
    """What became of one sensor's samples."""

    accepted: int = 0
    gated: int = 0  # kept out
    recovered: int = 0  # taken by widening the covariance; counted among the accepted too
    since: int | None = None  # ns, stamp of the last one taken, or of the first one


class InnovationGate:
    """Gate of one sensor.

    Args:
        size: dimension of the measurement.
        probability: share of good samples let in.
        timeout_s: how long all may be kept out, s.
    """

    def __init__(self, size: int, probability: float, timeout_s: float) -> None:
        self.limit = float(chi2.ppf(probability, size))
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
