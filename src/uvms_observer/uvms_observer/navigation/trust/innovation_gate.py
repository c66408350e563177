"""The innovation gate of one sensor: rejects what is unlikely.

A residual's squared Mahalanobis distance is chi-square distributed when the models of filter and
sensor are right. Beyond the gate a sample is not used, however often: a sensor that lies for a
minute must not move the estimate. The estimate grows less certain meanwhile, as its inertial unit
is, so that a sensor that tells the truth is believed again as soon as it may be right.

One that begins to lie with a jump does not come back until it has jumped again, to where it agrees:
that the estimate has become uncertain enough for both is no reason to believe it. What if the
estimate itself is wrong, `suspicion.py` looks into.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.special import gammaincinv

from uvms_core.signals import Array
from uvms_dynamics.kernels.jit import exact_kernel
from uvms_observer.navigation.state import WIDEST
from uvms_observer.navigation.trust import consistency

ROW = 3
"""Samples in a row beyond the gate that exclude a sensor."""
READMITTED = 0.95
"""Share of good samples with which an excluded sensor may come back: it must agree well, and not
slip in at the edge of an estimate that has become uncertain without it."""
RETURNED = 0.999
"""The same of one that has jumped back, or that is better known than the estimate by now."""
JUMP = 1.0 - 1e-5
"""Share of good samples that are nearer than a jump to the mean of those before: a fault of a
minute has hundreds."""
FAR = 2.2
"""Jumps of which to wait for the end are larger than the least that shows, in squares: both ends
must show whatever the noise."""
LEVEL = 0.25
"""Weight of a new sample in the running mean of residuals of a sensor that has jumped."""
MOVES = 0.15
"""Share of its std by which an estimate that is uncertain moves within some samples, as other
sensors tell of tilt and biases: that is no jump of the sensor."""
CHANCES = 8
"""Samples after a jump among which one must agree, as of 20 good ones one does not."""
WORN = 3.0
"""Standard deviations of the estimate beyond the size of a jump from which on the sensor, were it
off by that, still knew better."""
WINDOW_S = 1.0
"""Over which the mean of the residuals is taken, s."""
FEW = 8
"""Samples of which a sum says something."""


def quantile(size: int, probability: float) -> float:
    """Of the chi-square distribution; scipy.stats has the same number and loads in a second."""
    return 2.0 * float(gammaincinv(0.5 * size, probability))


class Away(NamedTuple):
    """A sensor that has jumped away, and has not come back."""

    by: Array  # (size,) residual after the jump
    level: Array  # (size,) running mean of the residuals since then
    chances: int = 0  # samples left among which it may agree

    def back(self, residual: Array) -> "Away":
        """After a jump back, to this residual."""
        return Away(self.by, residual.copy(), CHANCES)


class Tally(NamedTuple):
    """Counts of one sensor's samples."""

    accepted: int = 0
    gated: int = 0  # rejected
    row: int = 0  # of these, the ones since the last one that was used
    since: int | None = None  # ns, stamp of the first of these
    used: int | None = None  # ns, stamp of the last one used
    distance: float = 0.0  # sum of the squared distances of those that were used
    mean: Array = np.zeros(WIDEST)  # running mean of their residuals, of std 1 in a right filter
    away: Away | None = None
    level: float = 1.0  # running mean of the squared distances, in units of the size

    @property
    def excluded(self) -> bool:
        """Whether the sensor's samples are not used at present."""
        return self.row >= ROW


class InnovationGate:
    """Gate of one sensor.

    Args:
        size: dimension of the measurement.
        probability: share of good samples that is accepted.
        period_s: between two samples.
    """

    def __init__(self, size: int, probability: float, period_s: float) -> None:
        self.limit = quantile(size, probability)
        self._size = size
        self._readmission = quantile(size, READMITTED)
        self._return = quantile(size, RETURNED)
        # a sample less the running mean, which has a share LEVEL / (2 - LEVEL) of its variance
        self._jump = quantile(size, JUMP) * (1.0 + LEVEL / (2.0 - LEVEL))
        stays = consistency.keep_of(period_s)
        self.bound = consistency.bound(size, stays)
        self.weights = size, 1.0 - 1.0 / max(FEW, WINDOW_S / period_s), 1.0 - stays
        """Last arguments of `followed`."""

    def apply(
        self, tally: Tally, stamp: int, correct: Callable[[float], float], innovation: Array
    ) -> Tally:
        """Correct within the gate; returns the new tally.

        Args:
            tally: of this sensor so far.
            stamp: of the sample, ns.
            correct: corrects the state if the distance is within its argument; returns it.
            innovation: of the state, into which `correct` writes.
        """
        limit, away = self._readmission if tally.excluded else self.limit, tally.away
        if away is not None:
            correct(-1.0)
            away = self._followed(away, innovation)
            limit = self._return if self._may_come_back(away, innovation) else -1.0
        distance = correct(limit)
        if distance <= limit:
            before = tally.distance, tally.level, tally.mean
            return accepted(
                tally, stamp, 1, *followed(*before, distance, innovation, *self.weights)
            )
        return self.rejected(tally, stamp, innovation, away)

    def rejected(
        self, tally: Tally, stamp: int, innovation: Array, away: Away | None = None
    ) -> Tally:
        """The tally after a sample that was not used; `away` as it is after it."""
        if tally.row == 0:
            away = self._jumped(innovation)
        since = tally.since if tally.row else stamp
        return tally._replace(gated=tally.gated + 1, row=tally.row + 1, since=since, away=away)

    def refused(self, tally: Tally, stamp: int) -> Tally:
        """The tally after a sample that is no measurement, whatever it reads."""
        since = tally.since if tally.row else stamp
        return tally._replace(gated=tally.gated + 1, row=tally.row + 1, since=since)

    def _jumped(self, innovation: Array) -> Away | None:
        """What to remember of the first sample that was rejected."""
        residual = innovation[0, : self._size].copy()
        far = self._squared(residual, innovation) > FAR * self._jump
        return Away(residual, residual) if far else None

    def _followed(self, away: Away, innovation: Array) -> Away:
        """The same with one more sample."""
        residual, spread = innovation[0, : self._size], innovation[2, : self._size]
        change = residual - away.level
        std = np.hypot(innovation[1, : self._size], MOVES * spread)
        if float(np.square(change / std).sum()) > self._jump:
            return Away(away.by, residual.copy(), CHANCES)
        return Away(away.by, away.level + LEVEL * change, max(away.chances - 1, 0))

    def _may_come_back(self, away: Away, innovation: Array) -> bool:
        is_worn = (innovation[2, : self._size] > WORN * np.abs(away.by)).all()
        return away.chances > 0 or bool(is_worn)

    def _squared(self, change: Array, innovation: Array) -> float:
        return float(np.square(change / innovation[1, : self._size]).sum())


def accepted(
    tally: Tally, stamp: int, count: int, total: float, level: float, mean: Array
) -> Tally:
    """The tally after so many samples that were used, the last of this stamp; see `followed`."""
    return Tally(tally.accepted + count, tally.gated, 0, None, stamp, total, mean, None, level)


@exact_kernel
def followed(
    total: float,
    level: float,
    mean: Array,
    distance: float,
    innovation: Array,
    size: int,
    keep: float,
    new: float,
) -> tuple[float, float, Array]:
    """Sum of the distances, level and mean of a tally after a sample that was used.

    Args:
        total, level, mean: before it.
        distance: of its residual, squared.
        innovation: of the state after it.
        size: of the measurement.
        keep: share of the mean that stays.
        new: weight of the sample in the level.
    """
    after, weight = np.zeros(WIDEST), np.sqrt(1.0 - keep * keep)
    for i in range(size):
        std = innovation[2, i] if innovation[2, i] > 0.0 else 1.0
        after[i] = keep * mean[i] + weight * innovation[0, i] / std
    return total + distance, level + new * (distance / size - level), after
