"""Whether residuals are as large as the covariance says, and what to do where they are not.

The squared distance of a residual of size m has the mean m in a right filter (NIS: normalized
innovation squared). Its running mean over `WINDOW_S`, in units of m, is the sensor's level: about
1. Where it is beyond what chance explains, noise or model are worse than the vehicle file says, and
the covariance that is given to others is scaled by it. Bar-Shalom, Li and Kirubarajan (2001), 5.4.
"""

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from uvms_core.diagnostics import WARN, Trouble
from uvms_core.signals import to_nanoseconds

if TYPE_CHECKING:
    from uvms_observer.navigation.trust.innovation_gate import Tally

WINDOW_S = 10.0
"""Time constant of the running mean, s."""
CHANCE = 5.0
"""Standard deviations of the level about 1 that are still chance."""
LEAST = 2.0
"""Level that is left alone in any case: errors that are constant over the window, as a mounting's,
make levels of 1.5 in a right filter, too."""
TOGETHER = 2
"""Sensors that are excluded at the same time where it is the estimate that is wrong: two that lie
at once are rarer."""
FOR = to_nanoseconds(8.0)
"""For how long. By then `suspicion.py` has tried what else it may be."""


def keep_of(period_s: float) -> float:
    """Share of the level that stays from one sample to the next."""
    return float(np.exp(-period_s / WINDOW_S))


def bound(size: int, keep: float) -> float:
    """Largest level that is chance: the mean of so many chi-square numbers, weighted."""
    count = (1.0 + keep) / (1.0 - keep)
    return max(LEAST, 1.0 + CHANCE * float(np.sqrt(2.0 / (size * count))))


def trouble_of(beyond: Mapping[str, float], resets: int) -> Trouble | None:
    """What there is to say of the estimate itself; None where it is as it says."""
    texts = []
    if beyond:
        texts.append(f"residuals are larger than stated noise explains: {', '.join(beyond)}")
    if resets:
        texts.append(f"the estimate was given up and begun anew {resets} times")
    return Trouble(WARN, "; ".join(texts)) if texts else None


def given_up(tallies: Mapping[str, "Tally"], stamp: int) -> int | None:
    """Since when (ns) so many sensors contradict the estimate that it is wrong; None: they do not.

    Only sensors that have been used before, and whose samples still come, are witnesses.
    """
    excluded = [tally for tally in tallies.values() if tally.excluded]
    if len(excluded) < TOGETHER:
        return None
    since = sorted(
        tally.since for tally in excluded if tally.since is not None and tally.used is not None
    )
    if len(since) < TOGETHER or stamp - since[TOGETHER - 1] < FOR:
        return None
    return since[TOGETHER - 1]


def contradicted(tallies: Mapping[str, "Tally"], stamp: int) -> int:
    """Since when (ns) some sensor has contradicted the estimate at `stamp`."""
    return min(
        (tally.since for tally in tallies.values() if tally.row and tally.since is not None),
        default=stamp,
    )
