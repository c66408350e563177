"""The innovation gate of one sensor: rejects what is unlikely.

A residual's squared Mahalanobis distance is chi-square distributed when the models of filter and
sensor are right. Beyond the gate a sample is not used, however often: a sensor that lies for a
minute must not move the estimate. The estimate grows less certain meanwhile, as its inertial unit
is, so that a sensor that tells the truth is believed again as soon as it may be right. What if the
estimate itself is wrong, `suspicion.py` looks into.
"""

from collections.abc import Callable
from typing import NamedTuple

from scipy.special import gammaincinv

ROW = 3
"""Samples in a row beyond the gate that exclude a sensor."""
READMITTED = 0.95
"""Share of good samples with which an excluded sensor may come back: it must agree well, and not
slip in at the edge of an estimate that has become uncertain without it."""


def quantile(size: int, probability: float) -> float:
    """Of the chi-square distribution; scipy.stats has the same number and loads in a second."""
    return 2.0 * float(gammaincinv(0.5 * size, probability))


class Tally(NamedTuple):
    """Counts of one sensor's samples."""

    accepted: int = 0
    gated: int = 0  # rejected
    row: int = 0  # of these, the ones since the last one that was used
    since: int | None = None  # ns, stamp of the first of these
    used: int | None = None  # ns, stamp of the last one used
    distance: float = 0.0  # sum of the squared distances of those that were used

    @property
    def excluded(self) -> bool:
        """Whether the sensor's samples are not used at present."""
        return self.row >= ROW


class InnovationGate:
    """Gate of one sensor.

    Args:
        size: dimension of the measurement.
        probability: share of good samples that is accepted.
    """

    def __init__(self, size: int, probability: float) -> None:
        self.limit = quantile(size, probability)
        self._readmission = quantile(size, READMITTED)

    def apply(self, tally: Tally, stamp: int, correct: Callable[[float], float]) -> Tally:
        """Correct within the gate; returns the new tally.

        Args:
            tally: of this sensor so far.
            stamp: of the sample, ns.
            correct: corrects the state if the distance is within its argument; returns it.
        """
        accepted, gated, row, since, used, total = tally
        limit = self._readmission if tally.excluded else self.limit
        distance = correct(limit)
        if distance <= limit:
            return Tally(accepted + 1, gated, 0, None, stamp, total + distance)
        return Tally(accepted, gated + 1, row + 1, since if row else stamp, used, total)
