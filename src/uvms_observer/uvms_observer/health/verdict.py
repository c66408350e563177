"""From the evidence on every thruster to a verdict: none, one suspected, one certain."""

from dataclasses import dataclass

import numpy as np

from uvms_core.signals import Array
from uvms_observer.health import evidence as columns

SUSPECTED, CERTAIN = 40.0, 60.0
"""Fall of chi^2 from which a fault is suspected, and certain. By chance one of some 20 onsets of
some 10 thrusters reaches 22 once in a thousand windows that do not overlap; the rest is for noise
that is not white."""
UNEXPLAINED = 0.1
"""Share of what is beyond the noise that a fault may leave: errors of lag and model. A disturbance
that happens to lie near a thruster's direction leaves more."""
MODEL_NOISE = 0.15
"""chi^2 per value by which the noise itself may be larger than it was."""
MARGIN, MARGIN_SHARE = 20.0, 0.08
"""By how much, of chi^2, and by what share of its own fall a thruster must be a better explanation
than any other."""
IN_STEP = 20.0
"""By how much of chi^2 a fault must explain more than a disturbance that the thrust follows."""
LEAST = 0.25
"""Share from which a loss, or a change of one, is named. The authority of a healthy thruster is
known to a fifth."""
LEAST_CHANGE = 0.05
"""Share by which what is believed of a weak thruster is set right."""


@dataclass(frozen=True)
class Verdict:
    """What a window says: the thruster, the share that it lost beyond what is believed, its std.

    `thruster` is -1 where none stands out, and a mere suspect where it is not `certain`; `onset`
    is the tick in the window.
    """

    thruster: int = -1
    certain: bool = False
    share: float = 0.0
    sigma: float = 0.0
    onset: int = 0


NOTHING = Verdict()


def decide(evidence: Array, lost: Array) -> Verdict:
    """The verdict on the evidence (m, COLUMNS) of a window; shares `lost` (m,) are known."""
    gains = evidence[:, columns.GAIN]
    i = int(gains.argmax())
    gain = gains[i]
    share = evidence[i, columns.SHARE]
    least = LEAST if lost[i] == 0.0 else LEAST_CHANGE
    if gain < SUSPECTED or abs(share) < least or not _explains(evidence[i]):
        return NOTHING
    others = np.delete(gains, i).max(initial=0.0)
    alone = gain - others >= max(MARGIN, MARGIN_SHARE * gain)
    if not alone or not _is_in_step(evidence[i]):
        return NOTHING
    sigma = abs(share) / np.sqrt(gain)  # of a regression; of a stuck thrust what chi^2 is worth
    onset = int(evidence[i, columns.ONSET])
    return Verdict(i, bool(gain >= CERTAIN), float(share), float(sigma), onset)


def _is_in_step(row: Array) -> bool:
    """Whether the loss has the thruster's direction in several channels, or is in step with it.

    Where one channel alone speaks, as of a thruster that pushes along one axis, any disturbance has
    its direction; then a jump, as of a stuck thrust, says nothing.
    """
    has_direction = row[columns.BESIDES] * row[columns.GAIN] >= MARGIN
    is_jump = row[columns.KIND] == columns.STUCK
    return bool(has_direction or (not is_jump and row[columns.FOLLOWED] <= -IN_STEP))


def _explains(row: Array) -> bool:
    """Whether what is left after the fault is noise, but for a small share."""
    left, fall = row[columns.LEFT] - 1.0, row[columns.TOTAL] - 1.0
    return bool(left <= UNEXPLAINED * fall + MODEL_NOISE)
